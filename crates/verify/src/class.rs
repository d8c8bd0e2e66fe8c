//! Classes of paths, in the notation of Heckbert ("Adaptive Radiosity Textures for Bidirectional Ray Tracing", 1990).

use std::fmt;

use caustica_scene::Scene;
use caustica_scene::light::LightPoint;
use caustica_transport::{Contribution, Strategy};

/// What stands at the lamp's end of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LampEnd {
    /// A surface: eye paths can hit it, and light paths can be seen to leave it.
    Surface,
    /// An environment: eye paths can leave the scene towards it.
    Environment,
    /// A lamp without extent, in place or direction: a point, a spot, a sun. No path hits it by chance.
    Dirac,
}

impl LampEnd {
    /// That of a point on a lamp.
    pub fn of(scene: &Scene, point: &LightPoint) -> Self {
        let light = scene.lamps().get(point.light);
        match (light.is_delta(), light.is_infinite()) {
            (true, _) => Self::Dirac,
            (false, true) => Self::Environment,
            (false, false) => Self::Surface,
        }
    }
}

/// Classes remember this many surface vertices; longer paths keep the ends and what is needed to tell who reaches them.
const REMEMBERED: u32 = 48;

/// The class of a path: how each of its surface vertices scatters, from the lamp to the camera. S is a vertex that is
/// passed by a Dirac lobe, D any other, at which walks can be joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PathClass {
    lamp: LampEnd,
    /// Surface vertices between the lamp and the camera.
    length: u32,
    /// Bit i is set if vertex i, counted from the lamp, is a D. (Of long paths: of the first vertices.)
    diffuse: u64,
    /// Whether the vertex next to the camera is a D.
    last: bool,
    /// Whether two neighbours are both D.
    pair: bool,
}

impl PathClass {
    /// The class of a path whose vertices are D (true) or S, from the lamp on.
    pub fn new(lamp: LampEnd, vertices: impl IntoIterator<Item = bool>) -> Self {
        let mut class = Self { lamp, length: 0, diffuse: 0, last: false, pair: false };
        for diffuse in vertices {
            class.pair |= diffuse && class.last && class.length > 0;
            if class.length < REMEMBERED {
                class.diffuse |= u64::from(diffuse) << class.length;
            }
            class.last = diffuse;
            class.length += 1;
        }
        class
    }

    /// The class of a contribution's path.
    pub fn of(scene: &Scene, c: &Contribution<'_>) -> Self {
        let lamp = LampEnd::of(scene, &c.path.lamp);
        Self::new(lamp, c.events().map(|(_, dirac)| !dirac))
    }

    /// What is at its lamp's end.
    pub fn lamp(&self) -> LampEnd {
        self.lamp
    }

    /// How many edges it has.
    pub fn edges(&self) -> u32 {
        self.length + 1
    }

    /// Surface vertices between the lamp and the camera.
    pub fn len(&self) -> u32 {
        self.length
    }

    /// Whether the lamp is seen directly.
    pub fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Whether the vertex next to the lamp is a D.
    pub fn first(&self) -> bool {
        self.length > 0 && self.diffuse & 1 != 0
    }

    /// Whether the vertex next to the camera is a D.
    pub fn last(&self) -> bool {
        self.last
    }

    /// Whether it holds two D in a row, which inner connections need.
    pub fn has_pair(&self) -> bool {
        self.pair
    }

    /// Whether it holds any D: light that is scattered, and not the mere image of a lamp.
    pub fn has_diffuse(&self) -> bool {
        self.diffuse != 0 || self.last
    }

    /// Whether light is focused by S vertices and then falls on a D: a caustic.
    pub fn is_caustic(&self) -> bool {
        !self.first() && self.has_diffuse()
    }

    /// Whether vertex `i` from the lamp is a D. (What is not remembered of long paths counts as S.)
    fn is_diffuse(&self, i: u32) -> bool {
        if i + 1 == self.length { self.last } else { i < REMEMBERED && self.diffuse >> i & 1 != 0 }
    }

    /// Whether a strategy makes such paths: both vertices that it joins must be D, the lamp's end must be there to be
    /// hit if s = 0, and must have a place on the film if both ends are joined directly.
    pub fn is_made_by(&self, strategy: Strategy, parallel_camera: bool) -> bool {
        let Strategy { s, t } = strategy;
        if s + t != self.length + 2 || t == 0 {
            return false;
        }
        match (s, t) {
            (0, _) => self.lamp != LampEnd::Dirac,
            (1, 1) => match self.lamp {
                LampEnd::Surface => true,
                LampEnd::Environment => !parallel_camera,
                LampEnd::Dirac => false,
            },
            (1, _) => self.first(),
            (_, 1) => self.last,
            _ => self.is_diffuse(s - 2) && self.is_diffuse(s - 1),
        }
    }

    /// The class without the lengths of its chains: `LS+DE` for LSDE, LSSDE and so on.
    pub fn pattern(&self) -> String {
        let mut runs: Vec<(bool, u32)> = Vec::new();
        for i in 0..self.length.min(REMEMBERED) {
            match runs.last_mut() {
                Some((kind, count)) if *kind == self.is_diffuse(i) => *count += 1,
                _ => runs.push((self.is_diffuse(i), 1)),
            }
        }
        let text = |&(diffuse, count): &(bool, u32)| match (diffuse, count) {
            (true, 1) => "D",
            (true, _) => "DD+",
            (false, _) => "S+",
        };
        if runs.len() <= 3 {
            return format!("L{}E", runs.iter().map(text).collect::<String>());
        }
        if !self.pair && !self.first() && !self.last {
            return "LS+DS+(DS+)+E".to_owned();
        }
        let end = |diffuse| if diffuse { "D" } else { "S+" };
        format!("L{}(D|S)*{}E", end(self.first()), end(self.last))
    }
}

impl fmt::Display for PathClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let vertices = (0..self.length).map(|i| if self.is_diffuse(i) { 'D' } else { 'S' });
        write!(f, "L{}E", vertices.collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn class(lamp: LampEnd, text: &str) -> PathClass {
        PathClass::new(lamp, text.chars().map(|c| c == 'D'))
    }

    #[test]
    fn classes_are_written_as_heckbert_does() {
        for text in ["", "D", "SDS", "DSSSDD"] {
            assert_eq!(class(LampEnd::Dirac, text).to_string(), format!("L{text}E"));
        }
        for (text, pattern) in [
            ("", "LE"),
            ("D", "LDE"),
            ("DDDD", "LDD+E"),
            ("SSD", "LS+DE"),
            ("SDSS", "LS+DS+E"),
            ("SDSDS", "LS+DS+(DS+)+E"),
            ("SDSD", "LS+(D|S)*DE"),
            ("SDDSDS", "LS+(D|S)*S+E"),
        ] {
            assert_eq!(class(LampEnd::Dirac, text).pattern(), pattern, "{text}");
        }
    }

    #[test]
    fn strategies_join_what_is_no_mirror() {
        use LampEnd::*;
        let made = |lamp, text: &str| -> Vec<(u32, u32)> {
            let class = class(lamp, text);
            let n = class.len() + 2;
            let strategies = (0..n).map(|s| Strategy { s, t: n - s });
            strategies.filter(|s| class.is_made_by(*s, false)).map(|s| (s.s, s.t)).collect()
        };
        assert_eq!(made(Surface, ""), [(0, 2), (1, 1)]);
        assert_eq!(made(Dirac, ""), []);
        assert_eq!(made(Surface, "D"), [(0, 3), (1, 2), (2, 1)]);
        assert_eq!(made(Dirac, "SDS"), []);
        assert_eq!(made(Surface, "SDS"), [(0, 5)]);
        assert_eq!(made(Dirac, "SD"), [(3, 1)]);
        assert_eq!(made(Dirac, "DS"), [(1, 3)]);
        assert_eq!(made(Dirac, "SDDS"), [(3, 3)]);
        assert_eq!(made(Environment, "DDS"), [(0, 5), (1, 4), (2, 3)]);
        let direct = class(Environment, "");
        assert!(!direct.is_made_by(Strategy { s: 1, t: 1 }, true));
        assert!(!direct.is_made_by(Strategy { s: 2, t: 2 }, true));
    }

    #[test]
    fn long_paths_keep_their_ends() {
        let long = PathClass::new(LampEnd::Surface, (0..200).map(|i| i == 199));
        assert!(long.last() && !long.first() && long.is_caustic() && long.edges() == 201);
        assert!(long.is_made_by(Strategy { s: 201, t: 1 }, false));
    }
}
