//! Daylight: a clear sky and the sun in it.
//!
//! The sky is that of L. Hosek and A. Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance", 2012, in its RGB
//! form; the sun that of their "Adding a Solar-Radiance Function to the Hošek-Wilkie Skylight Model", 2013. Radiance is
//! in the unit in which a spectrum of 1 W·m⁻²·sr⁻¹·nm⁻¹ has luminance one. Colours outside of BT.709 are clipped to it.

mod sky;
mod sun;

pub use sky::SkyLight;
pub use sun::{LEAST_APERTURE, SUN_DIAMETER, SunLight};

use caustica_math::Vec3;

use crate::description::Daylight;

/// ∫ ȳ dλ of the standard observer, in nm: what the figures' luminance is divided by.
const WHOLE_Y: f32 = 106.750_26;

/// The turbidities for which there are figures: 1 to 10.
const TURBIDITIES: usize = 10;

/// A file of figures.
struct Figures(&'static [u8]);

impl Figures {
    fn get(&self, index: usize) -> f32 {
        let bytes = &self.0[4 * index..][..4];
        f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
    }

    /// Between two blocks of so many numbers, one a turbidity.
    fn between(&self, (low, part): (usize, f32), block: usize, index: usize) -> f32 {
        let [a, b] = [low, low + 1].map(|t| self.get(t * block + index));
        a * (1.0 - part) + b * part
    }
}

/// The turbidity below (from 0 on) for which there are figures, and the way to the next.
fn turbidity_between(turbidity: f32) -> (usize, f32) {
    let above_least = (turbidity - 1.0).clamp(0.0, (TURBIDITIES - 1) as f32);
    let low = (above_least as usize).min(TURBIDITIES - 2);
    (low, above_least - low as f32)
}

/// Where up and the sun are, in the world.
#[derive(Clone, Copy, Debug)]
pub struct Heaven {
    /// The axes of the sky's frame: the third points up.
    pub axes: [Vec3; 3],
    /// The unit direction to the middle of the sun.
    pub to_sun: Vec3,
    /// From 1 to 10.
    pub turbidity: f32,
}

impl Heaven {
    /// From unit axes.
    pub fn new(axes: [Vec3; 3], daylight: &Daylight) -> Result<Self, &'static str> {
        let to_sun = Vec3::from(daylight.to_sun).try_normalized();
        let to_sun = to_sun.ok_or("the direction to the sun must not be zero")?;
        let turbidity = daylight.turbidity;
        if !(1.0..=TURBIDITIES as f32).contains(&turbidity) {
            return Err("the turbidity must be from 1 to 10");
        }
        Ok(Self { axes, to_sun, turbidity })
    }

    /// Whether the middle of the sun is above the horizon: otherwise there is no light.
    pub fn is_day(&self) -> bool {
        self.to_sun.dot(self.axes[2]) >= 0.0
    }

    /// The sun's elevation in radians.
    fn elevation(&self) -> f32 {
        caustica_math::elementary::asin(self.to_sun.dot(self.axes[2])).max(0.0)
    }

    fn to_local(self, d: Vec3) -> Vec3 {
        Vec3::new(d.dot(self.axes[0]), d.dot(self.axes[1]), d.dot(self.axes[2]))
    }
}
