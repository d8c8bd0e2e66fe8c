use caustica_math::{Distribution1d, Mass, ONE_BELOW};

use super::tree::{Cone, Item, Leaf, LightTree};
use super::{Light, LightPoint, Receiver, Surroundings};

/// The part of the choice among lamps that is uniform.
const UNIFORM_PART: f64 = 0.1;

/// No lamp, and no triangle of one, gets a smaller share of a choice: of eight million at most, each can then be told
/// from its neighbours by the 24 bits of a number in [0, 1), and none is lost.
pub(super) const LEAST_SHARE: f32 = 1.0 / (1 << 23) as f32;

/// Fewer lamps and parts of lamps than this are chosen by power alone, wherever they are looked for from: a hierarchy
/// takes longer then than it helps.
pub const FEWEST_PARTS: usize = 8;

/// All lamps of a scene. Emission chooses them by power; next-event estimation too if they are few, and otherwise by a
/// hierarchy.
#[derive(Debug)]
pub struct Lights {
    lights: Vec<Light>,
    choice: Option<Distribution1d>,
    power: f64,
    environments: Vec<u32>,
    hierarchy: Option<Hierarchy>,
}

/// How a part of a lamp is chosen.
#[derive(Clone, Copy, Debug)]
pub(super) enum Part {
    /// It has been.
    Of(u32),
    /// By a number in [0, 1).
    By(f32),
}

/// A tree of all lamps that have a place, and those at infinity beside it.
#[derive(Debug)]
struct Hierarchy {
    tree: LightTree,
    beside: Option<Beside>,
}

/// Lamps at infinity.
#[derive(Debug)]
struct Beside {
    lights: Vec<u32>,
    /// By the irradiance that they may give.
    choice: Distribution1d,
    irradiance: f32,
}

/// The least probability of the tree, and of what is beside it, wherever either gives light: both irradiances are guesses.
const LEAST_SIDE: f32 = 0.1;

impl Lights {
    /// From lamps and the power of each.
    ///
    /// A small part of the choice is uniform: a lamp that is weak in all may be all the light of a place, and a
    /// probability must not vanish beside a sun's.
    pub fn new(lights: Vec<Light>, powers: &[f64]) -> Self {
        let environments = (0..lights.len() as u32)
            .filter(|i| matches!(lights[*i as usize], Light::Environment(_)))
            .collect();
        Self { choice: by_power(powers), lights, power: powers.iter().sum(), environments, hierarchy: None }
    }

    /// Builds the hierarchy if there are enough lamps, or parts of lamps, with the power of each.
    pub fn with_hierarchy(mut self, powers: &[f64], around: &Surroundings<'_>) -> Self {
        let parts = |l: &Light| match l {
            Light::Area(lamp) => lamp.part_count(),
            _ => usize::from(!l.is_infinite() && !matches!(l, Light::Collimated(_))),
        };
        let count: usize = self.lights.iter().map(parts).sum();
        if count < FEWEST_PARTS || self.choice.is_none() {
            return self;
        }
        let mut items = Vec::with_capacity(count);
        for (index, (light, power)) in self.lights.iter().zip(powers).enumerate() {
            items_of(light, (index as u32, *power), around, &mut |item| items.push(item));
        }
        self.hierarchy = LightTree::new(items, self.lights.len())
            .map(|tree| Hierarchy { tree, beside: Beside::new(&self.lights, powers, around) });
        self
    }

    /// How many lamps there are.
    pub fn len(&self) -> usize {
        self.lights.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.lights.is_empty()
    }

    /// Whether no light comes from any of them.
    pub fn are_black(&self) -> bool {
        self.choice.is_none()
    }

    /// Whether samples depend on `choice`: there are several lamps, or one of several parts.
    pub fn offer_a_choice(&self) -> bool {
        match &self.lights[..] {
            [Light::Area(lamp) | Light::Collimated(lamp)] => lamp.offers_a_choice(),
            lamps => lamps.len() > 1,
        }
    }

    /// The sum of all powers, in W.
    pub fn power(&self) -> f64 {
        self.power
    }

    /// The lamp of that index.
    #[inline]
    pub fn get(&self, index: u32) -> &Light {
        &self.lights[index as usize]
    }

    /// All lamps.
    pub fn iter(&self) -> impl Iterator<Item = &Light> {
        self.lights.iter()
    }

    /// Those that a path meets when it leaves the scene.
    #[inline]
    pub fn environments(&self) -> &[u32] {
        &self.environments
    }

    /// The lamps and parts of lamps in the hierarchy, if there is one.
    pub fn parts(&self) -> &[Leaf] {
        self.hierarchy.as_ref().map_or(&[], |h| h.tree.leaves())
    }

    /// The probability of a lamp by emission.
    #[inline]
    pub(super) fn mass(&self, light: u32) -> Mass {
        self.choice.as_ref().map_or(Mass(0.0), |c| c.mass(light as usize))
    }

    /// A lamp by power, with what is left of the number that chose it.
    #[inline]
    pub(super) fn choose(&self, u: f32) -> Option<(u32, Mass)> {
        let chosen = self.choice.as_ref()?.sample(u);
        Some((chosen.index as u32, chosen.mass))
    }

    /// A lamp for a place, how its part is found, and the probability of both.
    #[inline]
    pub(super) fn choose_for(&self, to: &Receiver, choice: [f32; 2]) -> Option<(u32, Part, Mass)> {
        match &self.hierarchy {
            None => self.choose(choice[0]).map(|(light, mass)| (light, Part::By(choice[1]), mass)),
            Some(hierarchy) => hierarchy.choose(to, choice),
        }
    }

    /// Whether parts of lamps are chosen together with the lamps.
    #[inline]
    pub(super) fn chooses_parts(&self) -> bool {
        self.hierarchy.is_some()
    }

    /// The probability of choosing for a place the lamp, or the part of it, on which a point is.
    #[inline]
    pub fn mass_for(&self, to: &Receiver, point: &LightPoint) -> Mass {
        match &self.hierarchy {
            None => self.mass(point.light),
            Some(hierarchy) => {
                let light = self.get(point.light);
                let part = match light {
                    Light::Area(lamp) => lamp.part_of(point.primitive),
                    Light::Collimated(_) => return Mass(0.0),
                    _ => 0,
                };
                hierarchy.mass(to, Leaf { light: point.light, part }, light.is_infinite())
            }
        }
    }
}

impl Hierarchy {
    /// The probability of the tree.
    #[inline]
    fn side(&self, to: &Receiver) -> f32 {
        let Some(beside) = &self.beside else { return 1.0 };
        let irradiance = self.tree.irradiance(to);
        if irradiance > 0.0 {
            (irradiance / (irradiance + beside.irradiance)).clamp(LEAST_SIDE, 1.0 - LEAST_SIDE)
        } else {
            0.0
        }
    }

    #[inline]
    fn choose(&self, to: &Receiver, [mut u, other]: [f32; 2]) -> Option<(u32, Part, Mass)> {
        let side = self.side(to);
        if let Some(beside) = &self.beside {
            if u >= side {
                let chosen = beside.choice.sample(((u - side) / (1.0 - side)).min(ONE_BELOW));
                let mass = Mass(chosen.mass.0 * (1.0 - side));
                return Some((beside.lights[chosen.index], Part::By(other), mass));
            }
            u /= side;
        }
        // A million leaves use up the 24 bits of one number: those of the other follow.
        let fine = f64::from(u) + f64::from(other) / f64::from(1 << 24);
        let (leaf, mass) = self.tree.choose(to, fine.min(f64::from(ONE_BELOW)))?;
        Some((leaf.light, Part::Of(leaf.part), Mass(mass.0 * side)))
    }

    #[inline]
    fn mass(&self, to: &Receiver, leaf: Leaf, infinite: bool) -> Mass {
        let side = self.side(to);
        if !infinite {
            return Mass(self.tree.mass(to, leaf).0 * side);
        }
        let Some(beside) = &self.beside else { return Mass(0.0) };
        // They are in order.
        let index = beside.lights.binary_search(&leaf.light);
        index.map_or(Mass(0.0), |index| Mass(beside.choice.mass(index).0 * (1.0 - side)))
    }
}

impl Beside {
    /// `None` if there are none.
    fn new(lights: &[Light], powers: &[f64], around: &Surroundings<'_>) -> Option<Self> {
        let across = std::f64::consts::PI * f64::from(around.radius) * f64::from(around.radius);
        let (mut infinite, mut irradiances) = (Vec::new(), Vec::new());
        for (index, (light, power)) in lights.iter().zip(powers).enumerate() {
            let part = match light {
                Light::Directional(_) => 1.0,
                Light::Environment(l) => l.part_on_surface(),
                _ => continue,
            };
            infinite.push(index as u32);
            irradiances.push(part * power / across);
        }
        let irradiance = irradiances.iter().sum::<f64>().min(f32::MAX.into()) as f32;
        Some(Self { lights: infinite, choice: by_power(&irradiances)?, irradiance })
    }
}

/// A choice by power, of which a small part is uniform.
fn by_power(powers: &[f64]) -> Option<Distribution1d> {
    let power: f64 = powers.iter().sum();
    let weight = |p: &f64| {
        let uniform = UNIFORM_PART / powers.len() as f64;
        ((1.0 - UNIFORM_PART) * p / power + uniform).max(f64::from(LEAST_SHARE)) as f32
    };
    let weights: Vec<f32> = if power > 0.0 { powers.iter().map(weight).collect() } else { Vec::new() };
    Distribution1d::new(&weights)
}

/// What a lamp puts into the hierarchy, given its index and its power: nothing if it is at infinity, or if it is never
/// found by looking for it.
fn items_of(
    light: &Light,
    (index, power): (u32, f64),
    around: &Surroundings<'_>,
    tell: &mut dyn FnMut(Item),
) {
    let point = |at, cone, intensity| Item {
        leaf: Leaf { light: index, part: 0 },
        min: at,
        max: at,
        cone,
        intensity,
    };
    let full = 4.0 * std::f64::consts::PI;
    match light {
        Light::Area(lamp) => lamp.parts(index, power, around, tell),
        Light::Point { position, .. } => tell(point(*position, Cone::ALL, power / full)),
        Light::Spot(l) => tell(point(l.position, l.cone(), power / f64::from(l.solid_angle()))),
        Light::Projector(l) => tell(point(l.position(), l.cone(), power / f64::from(l.solid_angle()))),
        Light::Collimated(_) | Light::Directional(_) | Light::Environment(_) => {}
    }
}
