//! What a page tells of a run.

use caustica_math::Rgb;
use caustica_report::{Estimated, Pattern, Shown, Verification};

use crate::outcome::{Outcome, PatternShare, Tested, Verdict};

/// Patterns with a smaller share of the light are not told.
const NEGLIGIBLE: f64 = 1e-4;

/// What a page shows, but for the heat map: see [`heat_map`](crate::heat_map). What is known of the run is added to
/// `notes`.
pub fn verification(
    outcome: &Outcome,
    (title, scene): (&str, &str),
    notes: Vec<(String, String)>,
) -> Verification {
    let mut all_notes = notes;
    all_notes.extend(
        [
            ("samples a pixel", format!("{}, reference {}", outcome.samples, outcome.reference_samples)),
            ("replicates", outcome.replicates.to_string()),
            ("blocks", format!("{0} × {0} pixels, merged up to the whole picture", outcome.grid.block)),
            (
                "significance",
                format!("{} for all tests together, {:.1e} each", outcome.significance, outcome.level),
            ),
        ]
        .map(|(name, value)| (name.to_owned(), value)),
    );
    Verification {
        title: title.to_owned(),
        scene: scene.to_owned(),
        verdict: verdict(outcome),
        agrees: outcome.agrees(),
        notes: all_notes,
        reference: shown(outcome, "reference", outcome.reference_pixels()),
        estimators: outcome.tested.iter().enumerate().map(|(i, t)| estimated(outcome, i, t)).collect(),
        patterns: outcome.patterns().into_iter().filter(is_told).map(|p| pattern(outcome, p)).collect(),
        heat_map: Vec::new(),
    }
}

fn is_told(p: &PatternShare) -> bool {
    p.share >= NEGLIGIBLE
}

fn verdict(outcome: &Outcome) -> String {
    let differ: Vec<&str> = outcome
        .tested
        .iter()
        .filter(|t| t.verdict == Verdict::Mismatch)
        .map(|t| t.estimator.name.as_str())
        .collect();
    match differ.as_slice() {
        [] if outcome.agrees() => {
            format!("All that could be tested agree, at a significance of {}.", outcome.significance)
        }
        [] => format!("The reference found {} values that are no numbers.", outcome.reference.invalid),
        names => format!(
            "These differ from what bdpt finds of the same paths, at a significance of {}: {}.",
            outcome.significance,
            names.join("; ")
        ),
    }
}

fn shown(outcome: &Outcome, name: &str, pixels: &[Rgb]) -> Shown {
    let window = outcome.grid.window;
    Shown { name: name.to_owned(), width: window.width, height: window.height, pixels: pixels.to_vec() }
}

fn estimated(outcome: &Outcome, index: usize, tested: &Tested) -> Estimated {
    let pixels = outcome.grid.pixels() as f64;
    let (estimate, reference) = (tested.whole().estimate, tested.whole().reference);
    let missed = outcome.missed(index).into_iter().filter(is_told);
    Estimated {
        name: tested.estimator.name.clone(),
        reach: tested.estimator.reach.to_owned(),
        missed: missed.map(|m| (m.pattern, m.share)).collect(),
        mean: estimate.mean / pixels,
        error: estimate.variance.sqrt() / pixels,
        expected: reference.mean / pixels,
        tests: tested.tests(),
        mismatches: tested.mismatches,
        smallest_p: tested.smallest_p(),
        untested: tested.untested,
        verdict: words(tested),
        picture: shown(outcome, &tested.estimator.name, &tested.picture.pixels),
    }
}

/// A verdict in words.
fn words(tested: &Tested) -> String {
    match tested.verdict {
        Verdict::Mismatch if tested.picture.invalid > 0 => {
            format!("{} values are no numbers", tested.picture.invalid)
        }
        Verdict::Mismatch => "differs".to_owned(),
        Verdict::Agrees if tested.untested > 0.05 => {
            format!("agrees where tested ({:.0} % of its light)", 100.0 * (1.0 - tested.untested))
        }
        Verdict::Agrees => "agrees".to_owned(),
        Verdict::TooNoisy => "too noisy to test".to_owned(),
        Verdict::NothingToReach => "reaches no light here".to_owned(),
    }
}

fn pattern(outcome: &Outcome, share: PatternShare) -> Pattern {
    let misses = |i: usize| {
        outcome.missed(i).iter().any(|m| (&m.pattern, m.lamp) == (&share.pattern, share.lamp) && is_told(m))
    };
    let names = outcome.tested.iter().enumerate().filter(|(i, _)| misses(*i));
    Pattern {
        missed_by: names.map(|(_, t)| t.estimator.name.clone()).collect(),
        pattern: share.pattern,
        lamp: share.lamp.to_owned(),
        share: share.share,
    }
}
