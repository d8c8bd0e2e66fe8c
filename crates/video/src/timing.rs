//! How far a change between two pictures has gone at a time.

/// From 0 to 1 and back once in a period, slowly at both ends: the share for a [`wipe`](crate::wipe) that
/// sweeps over the picture. `periods` is the time in periods.
pub fn sweep(periods: f32) -> f32 {
    let phase = fraction(periods);
    smooth(1.0 - (2.0 * phase - 1.0).abs())
}

/// 0 for the first half of a period and 1 for the second, with a short fade at each change: the
/// share for a [`cross_fade`](crate::cross_fade) that toggles. `fade` is the share of the period that
/// each fade takes, at the end of its half; 0 changes at once. `periods` is the time in periods.
pub fn toggle(periods: f32, fade: f32) -> f32 {
    let phase = 2.0 * fraction(periods);
    let (half, within) = if phase < 1.0 { (0.0, phase) } else { (1.0, phase - 1.0) };
    let length = (2.0 * fade).clamp(0.0, 1.0);
    let gone = if length > 0.0 { smooth(((within - 1.0 + length) / length).clamp(0.0, 1.0)) } else { 0.0 };
    if half == 0.0 { gone } else { 1.0 - gone }
}

fn fraction(time: f32) -> f32 {
    if time.is_finite() { time - time.floor() } else { 0.0 }
}

/// The cubic with flat ends.
fn smooth(x: f32) -> f32 {
    x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sweeps_go_there_and_back() {
        for (time, share) in [(0.0, 0.0), (0.25, 0.5), (0.5, 1.0), (0.75, 0.5), (1.0, 0.0), (-0.5, 1.0)] {
            assert_eq!(sweep(time), share, "{time}");
        }
        assert!(sweep(0.1) < 0.2 && sweep(f32::NAN) == 0.0 && sweep(f32::INFINITY) == 0.0);
    }

    #[test]
    fn toggles_hold_and_fade() {
        for (time, share) in [(0.0, 0.0), (0.39, 0.0), (0.45, 0.5), (0.5, 1.0), (0.89, 1.0), (0.95, 0.5)] {
            assert!((toggle(time, 0.1) - share).abs() < 1e-4, "{time}: {}", toggle(time, 0.1));
            assert!((toggle(time + 3.0, 0.1) - share).abs() < 1e-4);
        }
        assert_eq!((toggle(0.499, 0.0), toggle(0.5, 0.0), toggle(0.999, -1.0)), (0.0, 1.0, 1.0));
        assert!((0..100).all(|i| (0.0..=1.0).contains(&toggle(i as f32 / 30.0, 9.0))));
    }
}
