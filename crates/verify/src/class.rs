//! Classes of paths, in the notation of Heckbert ("Adaptive Radiosity Textures for Bidirectional Ray Tracing", 1990).

use std::fmt;

use caustica_scene::Scene;
use caustica_scene::camera::Joins;
use caustica_scene::light::{Light, LightPoint};
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
    /// A surface that shines along its normals alone: it is neither hit, nor found by looking for it.
    Collimated,
}

impl LampEnd {
    /// That of a point on a lamp.
    pub fn of(scene: &Scene, point: &LightPoint) -> Self {
        let light = scene.lamps().get(point.light);
        if matches!(light, Light::Collimated(_)) {
            return Self::Collimated;
        }
        match (light.is_delta(), light.is_infinite()) {
            (true, _) => Self::Dirac,
            (false, true) => Self::Environment,
            (false, false) => Self::Surface,
        }
    }
}

/// Classes remember so many vertices at either end, and of what lies between only what is needed to tell who reaches
/// them, and their pattern.
const REMEMBERED: u32 = 32;

/// More runs of equal vertices than this are not told apart.
const MOST_RUNS: u8 = 4;

/// The class of a path: how each of its surface vertices scatters, from the lamp to the camera. S is a vertex that is
/// passed by a Dirac lobe, D any other, at which walks can be joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PathClass {
    lamp: LampEnd,
    /// Surface vertices between the lamp and the camera.
    length: u32,
    /// Bit i is set if vertex i, counted from the lamp, is a D.
    head: u32,
    /// Bit i is set if vertex i, counted from the camera, is a D.
    tail: u32,
    /// Runs of equal vertices, up to [`MOST_RUNS`].
    runs: u8,
    /// Bit i is set if run i has more than one vertex.
    long_runs: u8,
    /// Whether two neighbours are both D.
    pair: bool,
}

impl PathClass {
    /// The class of a path whose vertices are D (true) or S, from the lamp on.
    pub fn new(lamp: LampEnd, vertices: impl IntoIterator<Item = bool>) -> Self {
        let mut class = Self { lamp, length: 0, head: 0, tail: 0, runs: 0, long_runs: 0, pair: false };
        for diffuse in vertices {
            class.push(diffuse);
        }
        class
    }

    /// Adds a vertex at the camera's end.
    fn push(&mut self, diffuse: bool) {
        if self.length > 0 && self.last() == diffuse {
            self.long_runs |= 1 << (self.runs - 1);
            self.pair |= diffuse;
        } else {
            self.runs = (self.runs + 1).min(MOST_RUNS);
        }
        if self.length < REMEMBERED {
            self.head |= u32::from(diffuse) << self.length;
        }
        self.tail = self.tail << 1 | u32::from(diffuse);
        self.length += 1;
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
        self.head & 1 != 0
    }

    /// Whether the vertex next to the camera is a D.
    pub fn last(&self) -> bool {
        self.tail & 1 != 0
    }

    /// Whether it holds any D: light that is scattered, and not the mere image of a lamp.
    pub fn has_diffuse(&self) -> bool {
        self.runs > 1 || self.first()
    }

    /// Whether light is focused by S vertices and then falls on a D: a caustic.
    pub fn is_caustic(&self) -> bool {
        !self.first() && self.has_diffuse()
    }

    /// Whether vertex `i` from the lamp is a D; `None` if that is not remembered.
    fn is_diffuse(&self, i: u32) -> Option<bool> {
        let from_camera = self.length - 1 - i;
        if i < REMEMBERED {
            Some(self.head >> i & 1 != 0)
        } else if from_camera < REMEMBERED {
            Some(self.tail >> from_camera & 1 != 0)
        } else {
            None
        }
    }

    /// Whether vertices `i` and `i + 1` from the lamp can be joined. Where that is not remembered: whether any two can.
    fn is_pair(&self, i: u32) -> bool {
        match (self.is_diffuse(i), self.is_diffuse(i + 1)) {
            (Some(a), Some(b)) => a && b,
            _ => self.pair,
        }
    }

    /// Whether a strategy makes such paths: both vertices that it joins must be D, the lamp's end must be there to be
    /// hit if s = 0, and must have a place on the film if they are joined with the camera.
    pub fn is_made_by(&self, strategy: Strategy, camera: Joins) -> bool {
        let Strategy { s, t } = strategy;
        if s + t != self.length + 2 || t == 0 {
            return false;
        }
        match (s, t) {
            (_, 1) if camera == Joins::Nothing => false,
            (0, _) => !matches!(self.lamp, LampEnd::Dirac | LampEnd::Collimated),
            (1, 1) => match self.lamp {
                LampEnd::Surface => true,
                LampEnd::Environment => camera == Joins::All,
                LampEnd::Dirac | LampEnd::Collimated => false,
            },
            (1, _) => self.first() && self.lamp != LampEnd::Collimated,
            (_, 1) => self.last(),
            _ => self.is_pair(s - 2),
        }
    }

    /// The class without the lengths of its chains: `LS+DE` for LSDE, LSSDE and so on.
    pub fn pattern(&self) -> String {
        let text = |i: u8| match (self.first() == i.is_multiple_of(2), self.long_runs >> i & 1 != 0) {
            (true, false) => "D",
            (true, true) => "DD+",
            (false, _) => "S+",
        };
        if self.runs < MOST_RUNS {
            return format!("L{}E", (0..self.runs).map(text).collect::<String>());
        }
        if !self.pair && !self.first() && !self.last() {
            return "LS+DS+(DS+)+E".to_owned();
        }
        let end = |diffuse| if diffuse { "D" } else { "S+" };
        format!("L{}(D|S)*{}E", end(self.first()), end(self.last()))
    }
}

impl fmt::Display for PathClass {
    /// With an ellipsis for what is not remembered of long paths.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("L")?;
        for i in 0..self.length {
            match self.is_diffuse(i) {
                Some(diffuse) => f.write_str(if diffuse { "D" } else { "S" })?,
                None if i == REMEMBERED => f.write_str("…")?,
                None => {}
            }
        }
        f.write_str("E")
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
            strategies.filter(|s| class.is_made_by(*s, Joins::All)).map(|s| (s.s, s.t)).collect()
        };
        assert_eq!(made(Surface, ""), [(0, 2), (1, 1)]);
        assert_eq!(made(Dirac, ""), []);
        assert_eq!(made(Collimated, ""), []);
        assert_eq!(made(Collimated, "D"), [(2, 1)]);
        assert_eq!(made(Collimated, "DD"), [(2, 2), (3, 1)]);
        assert_eq!(made(Surface, "D"), [(0, 3), (1, 2), (2, 1)]);
        assert_eq!(made(Dirac, "SDS"), []);
        assert_eq!(made(Surface, "SDS"), [(0, 5)]);
        assert_eq!(made(Dirac, "SD"), [(3, 1)]);
        assert_eq!(made(Dirac, "DS"), [(1, 3)]);
        assert_eq!(made(Dirac, "SDDS"), [(3, 3)]);
        assert_eq!(made(Environment, "DDS"), [(0, 5), (1, 4), (2, 3)]);
        let direct = class(Environment, "");
        assert!(!direct.is_made_by(Strategy { s: 1, t: 1 }, Joins::Near));
        assert!(!direct.is_made_by(Strategy { s: 2, t: 2 }, Joins::Near));
    }

    #[test]
    fn long_paths_keep_both_ends() {
        let long = PathClass::new(LampEnd::Surface, (0..200).map(|i| i == 199));
        assert!(long.last() && !long.first() && long.is_caustic() && long.edges() == 201);
        assert!(long.is_made_by(Strategy { s: 201, t: 1 }, Joins::All));
        assert!(!long.is_made_by(Strategy { s: 201, t: 1 }, Joins::Nothing));
        assert_eq!(long.pattern(), "LS+DE");
        assert_eq!(long.to_string(), format!("L{}…{}DE", "S".repeat(32), "S".repeat(31)));
        let class = |vertices: String| class(LampEnd::Dirac, &vertices);
        let hidden = |middle: &str| class(format!("{0}{middle}S{0}", "SD".repeat(40)) + "S");
        for (vertices, pattern) in [
            ("D".repeat(300), "LDD+E"),
            ("S".repeat(300), "LS+E"),
            (format!("D{}", "S".repeat(300)), "LDS+E"),
            (format!("{}SD", "D".repeat(300)), "LDD+S+DE"),
            (format!("S{}S", "D".repeat(300)), "LS+DD+S+E"),
            (format!("{}SSD", "DS".repeat(100)), "LD(D|S)*DE"),
            (format!("S{}", "DS".repeat(100)), "LS+DS+(DS+)+E"),
        ] {
            assert_eq!(class(vertices.clone()).pattern(), pattern, "{vertices}");
        }
        assert_eq!(hidden("DD").pattern(), "LS+(D|S)*S+E");
        // A pair of D in the middle can be joined, wherever it is.
        let inner = |c: &PathClass| {
            (2..c.len()).any(|s| c.is_made_by(Strategy { s, t: c.len() + 2 - s }, Joins::All))
        };
        assert!(inner(&hidden("DD")) && !inner(&hidden("")));
        // Up to 64 vertices, all is remembered.
        let text = format!("{}D{}", "S".repeat(40), "S".repeat(23));
        assert_eq!(class(text.clone()).to_string(), format!("L{text}E"));
    }
}
