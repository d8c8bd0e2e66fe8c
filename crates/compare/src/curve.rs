//! Error against time.

use caustica_report::CurvePoint;
use libm::{exp, log};

/// Logarithms of time and error of the points that have both.
fn logarithms(curve: &[CurvePoint]) -> Vec<[f64; 2]> {
    let finite = |p: &&CurvePoint| p.seconds > 0.0 && p.rel_mse > 0.0 && p.rel_mse.is_finite();
    curve.iter().filter(finite).map(|p| [log(p.seconds), log(p.rel_mse)]).collect()
}

/// The slope of log(relMSE) over log(seconds), by least squares: −1 for independent samples of finite variance.
/// `None` for fewer than three points.
pub fn slope(curve: &[CurvePoint]) -> Option<f64> {
    let points = logarithms(curve);
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let mean = |i: usize| points.iter().map(|p| p[i]).sum::<f64>() / n;
    let (x, y) = (mean(0), mean(1));
    let product =
        |i: usize, j: usize| points.iter().map(|p| (p[i] - [x, y][i]) * (p[j] - [x, y][j])).sum::<f64>();
    let spread = product(0, 0);
    (spread > 0.0).then(|| product(0, 1) / spread)
}

/// When an error was reached, in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reached {
    /// Then, between two points.
    At(f64),
    /// Before the first point, which is then.
    Before(f64),
}

/// When the error had come down to `rel_mse` for good: between points by a straight line in logarithms. `None` if it
/// never does.
pub fn time_to_reach(curve: &[CurvePoint], rel_mse: f64) -> Option<Reached> {
    let points = logarithms(curve);
    let target = log(rel_mse);
    let last_above = points.iter().rposition(|p| p[1] > target);
    match last_above {
        _ if !target.is_finite() => None,
        None => points.first().map(|p| Reached::Before(exp(p[0]))),
        Some(i) => points.get(i + 1).map(|b| {
            let a = points[i];
            Reached::At(exp(a[0] + (b[0] - a[0]) * (target - a[1]) / (b[1] - a[1])))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[(f64, f64)]) -> Vec<CurvePoint> {
        let point =
            |&(seconds, rel_mse)| CurvePoint { seconds, samples: 1.0, rel_mse, trimmed_rel_mse: rel_mse };
        points.iter().map(point).collect()
    }

    #[test]
    fn slopes_are_those_of_the_logarithms() {
        let halves = curve(&[(1.0, 0.4), (2.0, 0.2), (4.0, 0.1), (8.0, 0.05)]);
        assert!((slope(&halves).unwrap() + 1.0).abs() < 1e-12);
        let flat = curve(&[(1.0, 0.3), (2.0, 0.3), (9.0, 0.3), (10.0, f64::NAN)]);
        assert!(slope(&flat).unwrap().abs() < 1e-12);
        assert_eq!(slope(&halves[..2]), None);
        assert_eq!(slope(&curve(&[(1.0, 0.1); 5])), None);
    }

    #[test]
    fn times_lie_between_points() {
        let c = curve(&[(1.0, 0.4), (4.0, 0.1)]);
        let near = |a: Option<Reached>, b: f64| matches!(a, Some(Reached::At(t)) if (t - b).abs() < 1e-12);
        assert!(near(time_to_reach(&c, 0.2), 2.0) && near(time_to_reach(&c, 0.1), 4.0));
        assert_eq!(time_to_reach(&c, 0.8), Some(Reached::Before(1.0)));
        assert_eq!(time_to_reach(&c, 0.09), None);
        assert_eq!(time_to_reach(&[], 0.1), None);
        for odd in [0.0, f64::NAN, f64::INFINITY, -1.0] {
            assert_eq!(time_to_reach(&c, odd), None);
        }
        // A lucky start, then a bright speck: what counts is when it stays below.
        let c = curve(&[(1.0, 0.1), (2.0, 0.4), (8.0, 0.1)]);
        assert!(near(time_to_reach(&c, 0.2), 4.0));
    }
}
