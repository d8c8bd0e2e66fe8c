//! Classes of objects.

/// What an object is, by its tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Scene,
    Shape,
    Bsdf,
    Emitter,
    Sensor,
    Film,
    Filter,
    Sampler,
    Integrator,
    Texture,
    Spectrum,
    Medium,
    Phase,
    Volume,
    Subsurface,
}

/// Each tag and its class; the first tag of a class is its usual one.
const TAGS: &[(&str, Class)] = &[
    ("scene", Class::Scene),
    ("shape", Class::Shape),
    ("bsdf", Class::Bsdf),
    ("emitter", Class::Emitter),
    ("sensor", Class::Sensor),
    ("film", Class::Film),
    ("rfilter", Class::Filter),
    ("sampler", Class::Sampler),
    ("integrator", Class::Integrator),
    ("texture", Class::Texture),
    ("spectrum", Class::Spectrum),
    ("medium", Class::Medium),
    ("phase", Class::Phase),
    ("volume", Class::Volume),
    ("subsurface", Class::Subsurface),
];

impl Class {
    pub(super) fn from_tag(tag: &str) -> Option<Self> {
        TAGS.iter().find(|(t, _)| *t == tag).map(|(_, class)| *class)
    }

    /// The tag.
    pub(super) fn tag(self) -> &'static str {
        TAGS.iter().find(|(_, class)| *class == self).map_or("object", |(tag, _)| tag)
    }

    pub(super) fn tags() -> impl Iterator<Item = &'static str> {
        TAGS.iter().map(|(tag, _)| *tag)
    }

    /// Whether this can scatter or be looked up: several kinds of objects stand for a colour.
    pub(super) fn is_color(self) -> bool {
        matches!(self, Self::Texture | Self::Spectrum)
    }
}
