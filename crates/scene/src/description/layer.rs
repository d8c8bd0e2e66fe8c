use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// What a layer beside the picture tells of the first surface along each camera ray. Where there is none, all are zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum LayerKind {
    /// The colour of the material: see [`Scene::albedo`](crate::Scene::albedo).
    Albedo,
    /// Distance from the camera along the ray, from the near plane on.
    Depth,
    /// Where it is, in the world.
    Position,
    /// Texture coordinates; zero where the shape has none.
    Uv,
    /// The geometric normal.
    GeometricNormal,
    /// The shading normal, that of bump and normal maps included. It does not turn to the camera.
    ShadingNormal,
    /// ∂p/∂u; zero where texture coordinates do not tell.
    ByU,
    /// ∂p/∂v; zero where texture coordinates do not tell.
    ByV,
    /// How texture coordinates change from a pixel to the next one at the right.
    UvByX,
    /// How texture coordinates change from a pixel to the next one below.
    UvByY,
    /// The number of the triangle in its shape, from 0.
    PrimitiveIndex,
    /// The number of the shape in the scene, from 1; those of groups follow the others.
    ShapeIndex,
}

impl LayerKind {
    /// All.
    pub const ALL: [Self; 12] = [
        Self::Albedo,
        Self::Depth,
        Self::Position,
        Self::Uv,
        Self::GeometricNormal,
        Self::ShadingNormal,
        Self::ByU,
        Self::ByV,
        Self::UvByX,
        Self::UvByY,
        Self::PrimitiveIndex,
        Self::ShapeIndex,
    ];

    /// The name that users know it by: Mitsuba's.
    pub fn name(self) -> &'static str {
        match self {
            Self::Albedo => "albedo",
            Self::Depth => "depth",
            Self::Position => "position",
            Self::Uv => "uv",
            Self::GeometricNormal => "geo_normal",
            Self::ShadingNormal => "sh_normal",
            Self::ByU => "dp_du",
            Self::ByV => "dp_dv",
            Self::UvByX => "duv_dx",
            Self::UvByY => "duv_dy",
            Self::PrimitiveIndex => "prim_index",
            Self::ShapeIndex => "shape_index",
        }
    }

    /// What its channels' names end in: as Mitsuba's.
    pub fn channels(self) -> &'static [&'static str] {
        match self {
            Self::Albedo => &["R", "G", "B"],
            Self::Depth => &["T"],
            Self::Position | Self::GeometricNormal | Self::ShadingNormal | Self::ByU | Self::ByV => {
                &["X", "Y", "Z"]
            }
            Self::Uv | Self::UvByX | Self::UvByY => &["U", "V"],
            Self::PrimitiveIndex | Self::ShapeIndex => &["I"],
        }
    }

    /// Whether it is a number of something, of which there is no mean.
    pub fn is_index(self) -> bool {
        matches!(self, Self::PrimitiveIndex | Self::ShapeIndex)
    }
}

/// Of an unknown name, so many letters are told.
const SHOWN: usize = 40;

/// What `--layers` calls the shading normal.
const NORMAL: &str = "normal";

impl FromStr for LayerKind {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        if name == NORMAL {
            return Ok(Self::ShadingNormal);
        }
        Self::ALL.into_iter().find(|kind| kind.name() == name).ok_or_else(|| {
            let names: Vec<&str> = Self::ALL.iter().map(|kind| kind.name()).collect();
            let shown: String = name.chars().take(SHOWN).collect();
            format!("there is no layer `{shown}`: choose among {NORMAL}, {}", names.join(", "))
        })
    }
}

/// A layer that is written beside a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layer {
    /// What its channels' names begin with.
    pub name: String,
    /// What it tells.
    pub kind: LayerKind,
    /// Whether v grows downwards in it, as in Mitsuba's images: 1 − v is written for v.
    pub v_down: bool,
}

/// The longest name.
const LONGEST: usize = 200;

/// The layers of every picture.
const TAKEN: [&str; 4] = ["combined", "eye", "light", "error"];

impl FromStr for Layer {
    type Err = String;

    /// Reads `NAME:KIND`, or `KIND` alone, which then is its name.
    fn from_str(text: &str) -> Result<Self, String> {
        let (name, kind) = text.split_once(':').unwrap_or((text, text));
        let kind: LayerKind = kind.trim().parse()?;
        let name = name.trim().to_owned();
        if name.is_empty() || name.len() > LONGEST || !name.bytes().all(|b| b.is_ascii_graphic()) {
            let what = format!("a layer of `{}` needs a name of plain characters", kind.name());
            return Err(format!("{what}, at most {LONGEST} of them"));
        }
        if TAKEN.contains(&name.as_str()) {
            return Err(format!("the layer `{name}` is there already: choose another name"));
        }
        Ok(Self { name, kind, v_down: false })
    }
}

impl Layer {
    /// More layers are not written beside a picture.
    pub const MOST: usize = 64;

    /// Whether these can be written beside a picture.
    ///
    /// # Errors
    /// More than [`Self::MOST`], and channels of one name.
    pub fn check_all(layers: &[Self]) -> Result<(), String> {
        if layers.len() > Self::MOST {
            return Err(format!("more than {} layers are not written", Self::MOST));
        }
        for (i, layer) in layers.iter().enumerate() {
            if layers[..i].iter().any(|other| other.collides(layer)) {
                return Err(format!("two layers are called `{}`", layer.name));
            }
        }
        Ok(())
    }

    /// The names of its channels.
    pub fn channels(&self) -> impl Iterator<Item = String> {
        self.kind.channels().iter().map(|c| format!("{}.{c}", self.name))
    }

    /// Whether a channel of it has the name of one of the other's.
    pub fn collides(&self, other: &Self) -> bool {
        self.channels().any(|mine| other.channels().any(|theirs| mine == theirs))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_layers() {
        let layer = |text: &str| text.parse::<Layer>();
        for kind in LayerKind::ALL {
            let read = layer(kind.name()).unwrap();
            assert_eq!((read.name.as_str(), read.kind), (kind.name(), kind));
        }
        let named = layer(" dd.y : depth ").unwrap();
        assert_eq!((named.name.as_str(), named.kind), ("dd.y", LayerKind::Depth));
        assert_eq!(named.channels().collect::<Vec<_>>(), ["dd.y.T"]);
        assert_eq!(layer("normal").unwrap().kind, LayerKind::ShadingNormal);
        for (bad, why) in [
            ("boundary_test", "there is no layer `boundary_test`"),
            ("a:Depth", "there is no layer `Depth`"),
            (":depth", "needs a name"),
            ("ä:depth", "needs a name"),
            ("light:depth", "is there already"),
            ("", "there is no layer"),
        ] {
            assert!(layer(bad).unwrap_err().contains(why), "{bad}: {}", layer(bad).unwrap_err());
        }
        let collide = |a: &str, b: &str| layer(a).unwrap().collides(&layer(b).unwrap());
        assert!(collide("n:normal", "n:position") && collide("a.b:depth", "a.b:depth"));
        assert!(!collide("n:normal", "n:depth") && !collide("n:normal", "m:normal"));
    }
}
