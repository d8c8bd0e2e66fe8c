//! Every sampler of every BSDF draws from the density that it tells.
//!
//! Together the tests of each function have the significance level 0.01 (Šidák); seeds are fixed, so a test
//! that passes once passes always.

use crate::registry::{Example, WALKS, examples, given_directions, next_3d, random};
use caustica_math::Vec3;
use caustica_math::stats::{chi_square_test, sidak};
use caustica_scene::bsdf::Walk;
use caustica_testkit::chi_square::{ChiSquareConfig, chi_square_sphere};
use rayon::prelude::*;

/// One test of one BSDF: a walk and the direction that it is given.
struct Case<'a> {
    example: &'a Example,
    walk: Walk,
    given: Vec3,
}

impl Case<'_> {
    fn name(&self) -> String {
        format!("{}, {:?}, cos = {}", self.example.name, self.walk, self.given.z)
    }

    fn smooth_lobes(&self) -> Result<f64, String> {
        let bsdf = &self.example.bsdf;
        let mut sample = |u| {
            let s = bsdf.sample(self.walk, self.given, u).filter(|s| !s.delta)?;
            Some(s.direction)
        };
        let pdf = |v: Vec3| {
            f64::from(match self.walk {
                Walk::FromCamera => bsdf.eval(v, self.given).to_light_pdf.get(),
                Walk::FromLight => bsdf.eval(self.given, v).to_camera_pdf.get(),
            })
        };
        chi_square_sphere(&self.name(), &mut sample, &pdf, ChiSquareConfig::default())
    }

    /// Dirac lobes are as frequent as their probabilities tell.
    fn dirac_lobes(&self) -> Result<f64, String> {
        // Reflected, refracted, neither.
        let (mut observed, mut told) = ([0.0; 3], [0.0; 3]);
        let mut stream = random(7);
        let n = 20_000;
        for _ in 0..n {
            let bsdf = &self.example.bsdf;
            let s = bsdf.sample(self.walk, self.given, next_3d(&mut stream));
            let Some(s) = s.filter(|s| s.delta || !bsdf.is_partly_delta()) else {
                observed[2] += 1.0;
                continue;
            };
            if !s.delta {
                return Err(format!("{}: a lobe that is not Dirac", self.name()));
            }
            let lobe = usize::from(s.direction.z * self.given.z < 0.0);
            observed[lobe] += 1.0;
            told[lobe] = f64::from(s.pdf.get());
        }
        if self.example.bsdf.is_partly_delta() {
            told[2] = 1.0 - told[0] - told[1];
        } else if (told[0] + told[1] - 1.0).abs() > 1e-6 {
            return Err(format!("{}: the lobes' probabilities are {told:?}", self.name()));
        }
        let n = f64::from(n);
        Ok(chi_square_test(&observed, &told.map(|p| p * n), 5.0, n).p_value)
    }
}

fn run<'a>(cases: &[Case<'a>], test: impl Fn(&Case<'a>) -> Result<f64, String> + Sync) {
    assert!(!cases.is_empty());
    let level = sidak(0.01, cases.len());
    let failures: Vec<String> = cases
        .par_iter()
        .filter_map(|case| match test(case) {
            Err(message) => Some(message),
            Ok(p) if p < level => Some(format!("{}: p = {p:.2e} < {level:.2e}", case.name())),
            Ok(_) => None,
        })
        .collect();
    assert!(failures.is_empty(), "{} of {} fail:\n{}", failures.len(), cases.len(), failures.join("\n"));
}

fn cases(examples: &[Example], delta: bool) -> Vec<Case<'_>> {
    let mut cases = vec![];
    for example in examples.iter().filter(|e| e.bsdf.is_delta() == delta || e.bsdf.is_partly_delta()) {
        for walk in WALKS {
            for given in given_directions(&example.bsdf) {
                cases.push(Case { example, walk, given });
            }
        }
    }
    cases
}

#[test]
fn samples_follow_their_densities() {
    run(&cases(&examples(), false), Case::smooth_lobes);
}

#[test]
fn dirac_lobes_are_as_frequent_as_they_say() {
    run(&cases(&examples(), true), Case::dirac_lobes);
}
