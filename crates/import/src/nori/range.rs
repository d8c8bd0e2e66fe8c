//! What values a property may have.

/// Bounds of a number.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Bounds {
    /// Any finite number.
    Finite,
    /// More than 0.
    Positive,
    /// 0 or more.
    NotNegative,
    /// More than 0, or infinite.
    PositiveOrInfinite,
    /// Between the two, neither included.
    Between(f64, f64),
    /// More than the first, up to the second.
    UpTo(f64, f64),
    /// Between the two, both included.
    Within(f64, f64),
}

impl Bounds {
    /// The value, or the rule that it breaks.
    pub(crate) fn check(self, value: f64) -> Result<f32, String> {
        let (allowed, rule) = match self {
            Self::Finite => (true, "must be finite".to_owned()),
            Self::Positive => (value > 0.0, "must be finite and more than 0".to_owned()),
            Self::NotNegative => (value >= 0.0, "must be finite and not negative".to_owned()),
            Self::PositiveOrInfinite => (value > 0.0, "must be more than 0".to_owned()),
            Self::Between(a, b) => (value > a && value < b, format!("must be between {a} and {b}")),
            Self::Within(a, b) => ((a..=b).contains(&value), format!("must be from {a} to {b}")),
            Self::UpTo(a, b) => (value > a && value <= b, format!("must be more than {a} and at most {b}")),
        };
        let single = value as f32;
        let infinite_is_meant = matches!(self, Self::PositiveOrInfinite) && value == f64::INFINITY;
        // A positive number must not become zero by being stored in 32 bits.
        let kept = single.is_finite()
            && (single != 0.0 || value == 0.0 || matches!(self, Self::Between(a, _) if a < 0.0));
        if allowed && (kept || infinite_is_meant) { Ok(single) } else { Err(rule) }
    }
}

/// What a colour measures, which decides whether more than 1 is possible.
#[derive(Clone, Copy, Debug)]
pub(super) enum Radiometry {
    /// Emitted light: no upper bound.
    Light,
    /// A reflectance: more than 1 makes energy out of nothing, which is worth a warning.
    Reflectance,
    /// A share of a whole: more than 1 would leave a negative rest.
    Share,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_hold_for_the_stored_value() {
        assert!(Bounds::Positive.check(1e-60).is_err());
        assert!(Bounds::Between(-1.0, 1.0).check(1e60).is_err());
        assert!(Bounds::Between(-1.0, 1.0).check(1e-60).is_ok());
        assert_eq!(Bounds::PositiveOrInfinite.check(f64::INFINITY), Ok(f32::INFINITY));
        assert!(Bounds::PositiveOrInfinite.check(1e60).is_err());
        assert!(Bounds::Between(0.0, 180.0).check(180.0).is_err());
        assert!(Bounds::UpTo(0.0, 90.0).check(90.0).is_ok());
        assert!(Bounds::Within(0.0, 1.0).check(0.0).is_ok() && Bounds::Within(0.0, 1.0).check(1.0).is_ok());
        assert!(Bounds::Within(0.0, 1.0).check(1.001).is_err());
    }
}
