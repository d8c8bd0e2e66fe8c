//! Colours and spectra.

use std::ops::{Add, AddAssign, Div, Index, Mul, MulAssign, Sub};

use serde::{Deserialize, Serialize};

use crate::vector::larger;

/// A linear RGB triple with the primaries of ITU-R BT.709: the colours of descriptions and films.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
#[repr(transparent)]
pub struct Rgb(pub [f32; 3]);

impl Rgb {
    /// Black.
    pub const BLACK: Self = Self([0.0; 3]);
    /// One in each channel.
    pub const WHITE: Self = Self([1.0; 3]);

    /// The colour (r, g, b).
    pub const fn new(r: f32, g: f32, b: f32) -> Self {
        Self([r, g, b])
    }

    /// A grey.
    pub const fn splat(v: f32) -> Self {
        Self([v; 3])
    }

    /// The relative luminance Y of BT.709, with the weights that Nori's tests use.
    #[inline]
    pub fn luminance(self) -> f32 {
        0.212_671 * self.0[0] + 0.715_160 * self.0[1] + 0.072_169 * self.0[2]
    }

    /// The largest channel.
    #[inline]
    pub fn max_channel(self) -> f32 {
        self.0[0].max(self.0[1]).max(self.0[2])
    }

    /// Each channel through `f`.
    #[inline]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self(self.0.map(f))
    }

    /// Whether all channels are finite and none is negative.
    #[inline]
    pub fn is_valid(self) -> bool {
        self.0.iter().all(|c| c.is_finite() && *c >= 0.0)
    }
}

impl Add for Rgb {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self([self.0[0] + o.0[0], self.0[1] + o.0[1], self.0[2] + o.0[2]])
    }
}

impl Mul<f32> for Rgb {
    type Output = Self;
    #[inline]
    fn mul(self, k: f32) -> Self {
        self.map(|c| c * k)
    }
}

/// Four lanes of spectral quantity. Today lanes 0 to 2 carry linear BT.709 RGB and lane 3 is zero; in
/// spectral mode all four carry the wavelengths that [`Wavelengths`] names.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(16))]
pub struct Spectrum(pub [f32; 4]);

impl Spectrum {
    /// Zero in every lane.
    pub const ZERO: Self = Self([0.0; 4]);
    /// One in every lane that carries light.
    pub const ONE: Self = Self([1.0, 1.0, 1.0, 0.0]);

    /// The same value in every lane that carries light.
    #[inline]
    pub const fn splat(v: f32) -> Self {
        Self([v, v, v, 0.0])
    }

    /// Whether every lane is zero.
    #[inline]
    pub fn is_black(self) -> bool {
        self.0 == [0.0; 4]
    }

    /// The largest lane, if none is NaN.
    #[inline]
    pub fn max_lane(self) -> f32 {
        larger(larger(self.0[0], self.0[1]), larger(self.0[2], self.0[3]))
    }

    /// Whether all lanes are finite and none is negative.
    #[inline]
    pub fn is_valid(self) -> bool {
        self.0.iter().all(|c| c.is_finite() && *c >= 0.0)
    }

    /// Each lane through `f`.
    #[inline]
    pub fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self(self.0.map(f))
    }
}

impl Index<usize> for Spectrum {
    type Output = f32;
    #[inline]
    fn index(&self, lane: usize) -> &f32 {
        &self.0[lane]
    }
}

macro_rules! lanewise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Spectrum {
            type Output = Self;
            #[inline]
            fn $method(self, o: Self) -> Self {
                Self([
                    self.0[0] $op o.0[0],
                    self.0[1] $op o.0[1],
                    self.0[2] $op o.0[2],
                    self.0[3] $op o.0[3],
                ])
            }
        }
    };
}
lanewise!(Add, add, +);
lanewise!(Sub, sub, -);
lanewise!(Mul, mul, *);

impl Mul<f32> for Spectrum {
    type Output = Self;
    #[inline]
    fn mul(self, k: f32) -> Self {
        self.map(|c| c * k)
    }
}

impl Div<f32> for Spectrum {
    type Output = Self;
    #[inline]
    fn div(self, k: f32) -> Self {
        self * (1.0 / k)
    }
}

impl AddAssign for Spectrum {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl MulAssign for Spectrum {
    #[inline]
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}

impl MulAssign<f32> for Spectrum {
    #[inline]
    fn mul_assign(&mut self, k: f32) {
        *self = *self * k;
    }
}

/// What the four lanes of a sample's spectra stand for. Drawn once per sample; every conversion
/// between colours and spectra goes through it, so that a spectral mode is one more variant here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wavelengths {
    /// Three lanes of linear BT.709 RGB, and an empty one.
    #[default]
    Rgb,
}

impl Wavelengths {
    /// The spectrum of a colour: a reflectance, a radiance or an intensity.
    #[inline]
    pub fn spectrum(self, rgb: Rgb) -> Spectrum {
        match self {
            Self::Rgb => Spectrum([rgb.0[0], rgb.0[1], rgb.0[2], 0.0]),
        }
    }

    /// The colour that a spectrum contributes to the film.
    #[inline]
    pub fn rgb(self, s: Spectrum) -> Rgb {
        match self {
            Self::Rgb => Rgb([s.0[0], s.0[1], s.0[2]]),
        }
    }

    /// The luminance of a spectrum.
    #[inline]
    pub fn luminance(self, s: Spectrum) -> f32 {
        self.rgb(s).luminance()
    }
}
