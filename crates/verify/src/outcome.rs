//! What came out of a run.

use std::collections::BTreeMap;

use caustica_math::Rgb;
use serde::Serialize;

use crate::class::{LampEnd, PathClass};
use crate::estimator::Estimator;
use crate::grid::Grid;
use crate::tally::Picture;
use crate::trial::{Side, Trial};

/// What was found in a block.
#[derive(Clone, Copy, Debug)]
pub struct Finding {
    /// The test's outcome; `None` where too few contributions decide, or where both are black.
    pub trial: Option<Trial>,
    /// The estimator.
    pub estimate: Side,
    /// What the reference found of the paths that the estimator reaches.
    pub reference: Side,
}

/// A class of paths and its light.
#[derive(Clone, Debug)]
pub struct ClassShare {
    /// The class.
    pub class: PathClass,
    /// Its share of all light in the picture.
    pub share: f64,
    /// How many contributions the reference found.
    pub count: u64,
    /// Which estimators reach it, in their order.
    pub reached: Vec<bool>,
}

/// What is to be said of an estimator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It agrees with the reference in all blocks that could be tested.
    Agrees,
    /// It differs.
    Mismatch,
    /// Nothing could be tested with so few samples.
    TooNoisy,
    /// No light in this scene comes by paths that it reaches, and it found none.
    NothingToReach,
}

/// An estimator, tested.
#[derive(Clone, Debug)]
pub struct Tested {
    /// The estimator.
    pub estimator: Estimator,
    /// Its mean picture.
    pub picture: Picture,
    /// What was found, by level from the finest blocks to the whole picture.
    pub findings: Vec<Vec<Finding>>,
    /// Blocks whose test says that it differs, of all levels.
    pub mismatches: usize,
    /// The share of its light in blocks that could not be tested, even merged with others.
    pub untested: f64,
    /// The verdict.
    pub verdict: Verdict,
}

impl Tested {
    pub(crate) fn new(estimator: Estimator, picture: Picture, findings: Vec<Vec<Finding>>) -> Self {
        let verdict = Verdict::TooNoisy;
        Self { estimator, picture, findings, mismatches: 0, untested: 0.0, verdict }
    }

    fn trials(&self) -> impl Iterator<Item = Trial> {
        self.findings.iter().flatten().filter_map(|f| f.trial)
    }

    /// How many tests were made.
    pub fn tests(&self) -> usize {
        self.trials().count()
    }

    /// The smallest p of all tests; one if there were none.
    pub fn smallest_p(&self) -> f64 {
        self.trials().map(|t| t.p).fold(1.0, f64::min)
    }

    /// The whole picture's finding.
    pub fn whole(&self) -> &Finding {
        &self.findings[self.findings.len() - 1][0]
    }

    /// The test of the smallest block around a block of the finest level that could be tested.
    pub fn trial_of(&self, grid: &Grid, block: usize) -> Option<Trial> {
        (0..self.findings.len()).find_map(|level| self.findings[level][grid.ancestor(block, level)].trial)
    }

    /// Says how it stands, if differences below `level` count.
    pub(crate) fn judge(&mut self, grid: &Grid, level: f64) {
        self.mismatches = self.trials().filter(|t| t.p < level).count();
        let light = |b: usize| self.findings[0][b].reference.mean.abs();
        let blocks = 0..self.findings[0].len();
        let total: f64 = blocks.clone().map(light).sum();
        let untested =
            blocks.filter(|b| self.trial_of(grid, *b).is_none()).map(light).fold(0.0, |a, b| a + b);
        self.untested = if total > 0.0 { untested / total } else { 0.0 };
        let whole = self.whole();
        let black = whole.reference.mean == 0.0 && whole.estimate.mean == 0.0;
        self.verdict = if self.mismatches > 0 || self.picture.invalid > 0 {
            Verdict::Mismatch
        } else if black {
            Verdict::NothingToReach
        } else if self.tests() == 0 {
            Verdict::TooNoisy
        } else {
            Verdict::Agrees
        };
    }
}

/// A whole run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The blocks.
    pub grid: Grid,
    /// All classes of paths that carry light here.
    pub classes: Vec<ClassShare>,
    /// The reference's picture.
    pub reference: Picture,
    /// The estimators.
    pub tested: Vec<Tested>,
    /// The level of significance of each test.
    pub level: f64,
    /// That of all tests together.
    pub significance: f64,
    /// Samples per pixel of each estimator.
    pub samples: u32,
    /// Samples per pixel of the reference.
    pub reference_samples: u32,
    /// Into how many independent replicates they are split.
    pub replicates: u32,
}

/// Light by pattern of paths.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PatternShare {
    /// Such as `LS+DE`.
    pub pattern: String,
    /// Where its light is from.
    pub lamp: &'static str,
    /// Its share of all light.
    pub share: f64,
}

/// What people call a lamp's end.
pub fn lamp_name(lamp: LampEnd) -> &'static str {
    match lamp {
        LampEnd::Surface => "lamps with a surface",
        LampEnd::Environment => "the environment",
        LampEnd::Dirac => "lamps without extent",
        LampEnd::Collimated => "lamps that shine along their normals",
    }
}

/// Adds shares up by pattern, the brightest first.
pub fn by_pattern<'a>(classes: impl Iterator<Item = (&'a PathClass, f64)>) -> Vec<PatternShare> {
    let mut sums: BTreeMap<(LampEnd, String), f64> = BTreeMap::new();
    for (class, share) in classes {
        *sums.entry((class.lamp(), class.pattern())).or_default() += share;
    }
    let share = |((lamp, pattern), share)| PatternShare { pattern, lamp: lamp_name(lamp), share };
    let mut shares: Vec<PatternShare> = sums.into_iter().map(share).collect();
    shares.sort_by(|a, b| b.share.total_cmp(&a.share));
    shares
}

impl Outcome {
    /// Whether all estimators that could be tested agree.
    pub fn agrees(&self) -> bool {
        self.reference.invalid == 0 && self.tested.iter().all(|t| t.verdict != Verdict::Mismatch)
    }

    /// The light that an estimator cannot find in this scene, by pattern, the brightest first.
    pub fn missed(&self, estimator: usize) -> Vec<PatternShare> {
        by_pattern(self.classes.iter().filter(|c| !c.reached[estimator]).map(|c| (&c.class, c.share)))
    }

    /// All light by pattern, the brightest first.
    pub fn patterns(&self) -> Vec<PatternShare> {
        by_pattern(self.classes.iter().map(|c| (&c.class, c.share)))
    }

    /// The reference's pixels, row by row.
    pub fn reference_pixels(&self) -> &[Rgb] {
        &self.reference.pixels
    }
}
