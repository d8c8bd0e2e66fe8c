//! Classes of objects.

/// What an object is, by its tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Scene,
    Mesh,
    Bsdf,
    Emitter,
    Camera,
    Film,
    Medium,
    Phase,
    Integrator,
    Sampler,
    Filter,
    Texture,
    Test,
}

/// Each tag and its class; the first tag of a class is its usual one.
const TAGS: &[(&str, Class)] = &[
    ("scene", Class::Scene),
    ("mesh", Class::Mesh),
    ("shape", Class::Mesh),
    ("bsdf", Class::Bsdf),
    ("emitter", Class::Emitter),
    ("camera", Class::Camera),
    ("sensor", Class::Camera),
    ("film", Class::Film),
    ("medium", Class::Medium),
    ("phase", Class::Phase),
    ("integrator", Class::Integrator),
    ("sampler", Class::Sampler),
    ("rfilter", Class::Filter),
    ("texture", Class::Texture),
    ("test", Class::Test),
];

impl Class {
    pub(super) fn from_tag(tag: &str) -> Option<Self> {
        TAGS.iter().find(|(t, _)| *t == tag).map(|(_, class)| *class)
    }

    /// The usual tag.
    pub(super) fn tag(self) -> &'static str {
        TAGS.iter().find(|(_, class)| *class == self).map_or("object", |(tag, _)| tag)
    }

    pub(super) fn tags() -> impl Iterator<Item = &'static str> {
        TAGS.iter().map(|(tag, _)| *tag)
    }

    /// Whether the tag does not say all: there are several plugins of this class.
    pub(super) fn needs_type(self) -> bool {
        !matches!(self, Self::Scene | Self::Film)
    }
}
