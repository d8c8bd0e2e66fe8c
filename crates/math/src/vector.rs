//! Two- and three-component vectors.

use std::ops::{Add, AddAssign, Div, Index, Mul, MulAssign, Neg, Sub};

use serde::{Deserialize, Serialize};

/// A pair of coordinates: a point in the unit square, on the film, or in texture space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(C)]
pub struct Vec2 {
    /// First coordinate.
    pub x: f32,
    /// Second coordinate.
    pub y: f32,
}

impl Vec2 {
    /// The vector (x, y).
    #[inline]
    pub const fn new(x: f32, y: f32) -> Self {
        Self { x, y }
    }
}

impl Add for Vec2 {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y)
    }
}

impl Sub for Vec2 {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y)
    }
}

impl Mul<f32> for Vec2 {
    type Output = Self;
    #[inline]
    fn mul(self, k: f32) -> Self {
        Self::new(self.x * k, self.y * k)
    }
}

/// A triple of coordinates: a point, a direction or a normal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(C)]
pub struct Vec3 {
    /// First coordinate.
    pub x: f32,
    /// Second coordinate.
    pub y: f32,
    /// Third coordinate.
    pub z: f32,
}

/// The larger of two numbers, or the second if either is NaN: one instruction, where the library's has four.
#[inline]
pub(crate) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

impl Vec3 {
    /// The origin.
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);
    /// The unit vector along +x.
    pub const X: Self = Self::new(1.0, 0.0, 0.0);
    /// The unit vector along +y.
    pub const Y: Self = Self::new(0.0, 1.0, 0.0);
    /// The unit vector along +z.
    pub const Z: Self = Self::new(0.0, 0.0, 1.0);

    /// The vector (x, y, z).
    #[inline]
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        Self { x, y, z }
    }

    /// All three coordinates equal to `v`.
    #[inline]
    pub const fn splat(v: f32) -> Self {
        Self::new(v, v, v)
    }

    /// The scalar product.
    #[inline]
    pub fn dot(self, o: Self) -> f32 {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// The vector product (right-handed).
    #[inline]
    pub fn cross(self, o: Self) -> Self {
        Self::new(self.y * o.z - self.z * o.y, self.z * o.x - self.x * o.z, self.x * o.y - self.y * o.x)
    }

    /// The squared length.
    #[inline]
    pub fn length_squared(self) -> f32 {
        self.dot(self)
    }

    /// The length.
    #[inline]
    pub fn length(self) -> f32 {
        self.length_squared().sqrt()
    }

    /// This vector at length one. A zero vector gives NaN coordinates: use [`Vec3::try_normalized`]
    /// where it may occur.
    #[inline]
    pub fn normalized(self) -> Self {
        self * (1.0 / self.length())
    }

    /// This vector at length one, or `None` if its length is zero, subnormal or not finite. The
    /// length is taken in `f64`, so that neither tiny nor huge vectors lose their direction.
    pub fn try_normalized(self) -> Option<Self> {
        let (x, y, z) = (f64::from(self.x), f64::from(self.y), f64::from(self.z));
        let length = (x * x + y * y + z * z).sqrt();
        (length.is_finite() && length > f64::from(f32::MIN_POSITIVE))
            .then(|| Self::new((x / length) as f32, (y / length) as f32, (z / length) as f32))
    }

    /// Coordinate by coordinate minimum; that of `o` where either is NaN.
    #[inline]
    pub fn min(self, o: Self) -> Self {
        let min = |a, b| if a < b { a } else { b };
        Self::new(min(self.x, o.x), min(self.y, o.y), min(self.z, o.z))
    }

    /// Coordinate by coordinate maximum; that of `o` where either is NaN.
    #[inline]
    pub fn max(self, o: Self) -> Self {
        Self::new(larger(self.x, o.x), larger(self.y, o.y), larger(self.z, o.z))
    }

    /// Coordinate by coordinate absolute value.
    #[inline]
    pub fn abs(self) -> Self {
        Self::new(self.x.abs(), self.y.abs(), self.z.abs())
    }

    /// The largest coordinate, if none is NaN.
    #[inline]
    pub fn max_element(self) -> f32 {
        larger(larger(self.x, self.y), self.z)
    }

    /// Whether no coordinate is NaN or infinite.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }

    /// The three coordinates in order.
    #[inline]
    pub const fn to_array(self) -> [f32; 3] {
        [self.x, self.y, self.z]
    }

    /// The square of the distance to `o`.
    #[inline]
    pub fn distance_squared(self, o: Self) -> f32 {
        (self - o).length_squared()
    }
}

impl From<[f32; 3]> for Vec3 {
    #[inline]
    fn from(a: [f32; 3]) -> Self {
        Self::new(a[0], a[1], a[2])
    }
}

impl Index<usize> for Vec3 {
    type Output = f32;
    #[inline]
    fn index(&self, axis: usize) -> &f32 {
        match axis {
            0 => &self.x,
            1 => &self.y,
            _ => &self.z,
        }
    }
}

impl Add for Vec3 {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl AddAssign for Vec3 {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl Sub for Vec3 {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl Neg for Vec3 {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl Mul<f32> for Vec3 {
    type Output = Self;
    #[inline]
    fn mul(self, k: f32) -> Self {
        Self::new(self.x * k, self.y * k, self.z * k)
    }
}

impl Mul<Vec3> for f32 {
    type Output = Vec3;
    #[inline]
    fn mul(self, v: Vec3) -> Vec3 {
        v * self
    }
}

impl MulAssign<f32> for Vec3 {
    #[inline]
    fn mul_assign(&mut self, k: f32) {
        *self = *self * k;
    }
}

impl Div<f32> for Vec3 {
    type Output = Self;
    #[inline]
    fn div(self, k: f32) -> Self {
        Self::new(self.x / k, self.y / k, self.z / k)
    }
}
