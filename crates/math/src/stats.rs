//! The statistical tests by which samplers and integrators are checked: Pearson's χ², Student's and
//! Welch's t, and the Šidák correction for many tests at once.

use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

/// The significance level for each of `count` independent tests such that all of them together have
/// the level `alpha`: 1 − (1 − α)^(1/count) (Šidák, 1967).
pub fn sidak(alpha: f64, count: usize) -> f64 {
    1.0 - libm::pow(1.0 - alpha, 1.0 / count.max(1) as f64)
}

/// A running mean and variance (Welford, 1962).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// How many values were pushed.
    pub count: u64,
    /// Their mean.
    pub mean: f64,
    m2: f64,
}

impl Moments {
    /// Takes one more value in.
    #[inline]
    pub fn push(&mut self, value: f64) {
        self.count += 1;
        let delta = value - self.mean;
        self.mean += delta / self.count as f64;
        self.m2 += delta * (value - self.mean);
    }

    /// The unbiased variance of the values; zero for fewer than two.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { 0.0 } else { self.m2 / (self.count - 1) as f64 }
    }

    /// The variance of the mean.
    pub fn variance_of_mean(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.variance() / self.count as f64 }
    }
}

/// The two-sided p-value of a t statistic; NaN statistics give zero.
pub fn t_p_value(t: f64, degrees: f64) -> f64 {
    if t.is_nan() {
        return 0.0;
    }
    match StudentsT::new(0.0, 1.0, degrees.max(1.0)) {
        Ok(d) => 2.0 * (1.0 - d.cdf(t.abs())),
        Err(_) => 0.0,
    }
}

/// The value beyond which Student's t of so many degrees of freedom lies with probability `tail`, on that side.
pub fn t_quantile(tail: f64, degrees: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees.max(1.0)).map_or(f64::NAN, |d| d.inverse_cdf(1.0 - tail))
}

/// The value below which χ² of so many degrees of freedom lies with probability `tail`.
pub fn chi_square_quantile(tail: f64, degrees: f64) -> f64 {
    ChiSquared::new(degrees.max(1.0)).map_or(f64::NAN, |d| d.inverse_cdf(tail))
}

/// One-sample t-test that the mean is `reference`: the p-value. The variance is taken as 1e-5 at
/// least, as Nori's `ttest` does, so that constant samples can be tested.
pub fn student_t_test(sample: &Moments, reference: f64) -> f64 {
    let t = (sample.mean - reference).abs() * (sample.count as f64 / sample.variance().max(1e-5)).sqrt();
    t_p_value(t, sample.count.saturating_sub(1) as f64)
}

/// Welch's two-sample t-test that two means are equal: the p-value. `floor` is added to the variance
/// of each mean, for rounding; two constant samples of equal mean pass.
pub fn welch_t_test(a: &Moments, b: &Moments, floor: f64) -> f64 {
    let (va, vb) = (a.variance_of_mean() + floor, b.variance_of_mean() + floor);
    let v = va + vb;
    let difference = a.mean - b.mean;
    if v == 0.0 {
        return if difference == 0.0 { 1.0 } else { 0.0 };
    }
    let degrees = |v: f64, n: u64| v * v / n.saturating_sub(1).max(1) as f64;
    // Welch–Satterthwaite.
    t_p_value(difference / v.sqrt(), v * v / (degrees(va, a.count) + degrees(vb, b.count)))
}

/// The outcome of a χ² test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquareOutcome {
    /// The statistic; infinite if samples fell where none can.
    pub statistic: f64,
    /// Degrees of freedom after pooling.
    pub degrees: usize,
    /// The probability of a statistic as large as this if the density is right.
    pub p_value: f64,
}

/// Pearson's χ² test of `observed` counts against `expected` ones.
///
/// Cells that expect fewer than `minimum` are pooled. If more than `samples`·1e-5 of the samples fell
/// into a cell that expects none, the p-value is zero.
///
/// # Panics
/// If the slices differ in length.
pub fn chi_square_test(observed: &[f64], expected: &[f64], minimum: f64, samples: f64) -> ChiSquareOutcome {
    assert_eq!(observed.len(), expected.len());
    let impossible = ChiSquareOutcome { statistic: f64::INFINITY, degrees: 0, p_value: 0.0 };
    let mut cells: Vec<(f64, f64)> = observed.iter().copied().zip(expected.iter().copied()).collect();
    cells.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (mut statistic, mut count) = (0.0, 0usize);
    let (mut pooled_observed, mut pooled_expected) = (0.0, 0.0);
    let mut add = |o: f64, e: f64| {
        statistic += (o - e) * (o - e) / e;
        count += 1;
    };
    for (o, e) in cells {
        if e.is_nan() || e < 0.0 || (e == 0.0 && o > samples * 1e-5) {
            return impossible;
        }
        if e == 0.0 {
            continue;
        }
        if e < minimum || (pooled_expected > 0.0 && pooled_expected < minimum) {
            pooled_observed += o;
            pooled_expected += e;
        } else {
            add(o, e);
        }
    }
    if pooled_expected > 0.0 {
        add(pooled_observed, pooled_expected);
    }
    let degrees = count.saturating_sub(1);
    if degrees == 0 {
        return ChiSquareOutcome { statistic, degrees, p_value: 1.0 };
    }
    let p_value = ChiSquared::new(degrees as f64).map_or(0.0, |d| 1.0 - d.cdf(statistic));
    ChiSquareOutcome { statistic, degrees, p_value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_quantiles() {
        assert!((t_p_value(2.228, 10.0) - 0.05).abs() < 1e-4);
        assert!((sidak(0.01, 5) - 0.002_008).abs() < 1e-6);
        let o = chi_square_test(&[15.0, 5.0], &[10.0, 10.0], 5.0, 20.0);
        assert!((o.p_value - 0.0253).abs() < 1e-4);
    }

    #[test]
    fn moments_match_the_textbook() {
        let mut m = Moments::default();
        for v in [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0] {
            m.push(v);
        }
        assert!((m.mean - 5.0).abs() < 1e-12 && (m.variance() - 32.0 / 7.0).abs() < 1e-12);
    }

    #[test]
    fn tests_reject_what_is_wrong() {
        assert_eq!(chi_square_test(&[10.0, 90.0], &[0.0, 100.0], 5.0, 100.0).p_value, 0.0);
        assert!(chi_square_test(&[100.0, 300.0], &[200.0, 200.0], 5.0, 400.0).p_value < 1e-9);
        let constant = |v: f64| {
            let mut m = Moments::default();
            (0..10).for_each(|_| m.push(v));
            m
        };
        assert_eq!(welch_t_test(&constant(1.0), &constant(1.0), 0.0), 1.0);
        assert_eq!(welch_t_test(&constant(1.0), &constant(1.1), 0.0), 0.0);
        assert!(student_t_test(&constant(f64::NAN), 1.0) == 0.0);
    }
}
