//! Triangles and rectangles as they are seen from the origin: their solid angle, and points of them that are
//! uniform in it. Next-event estimation looks for lamps so.
//!
//! Lengths and products are `f64`: seen from near an edge or almost in their plane, what is computed here is small
//! differences of large terms. Sines and angles are `f32`; their error moves a point as another random number
//! would, and no further.

use crate::Vec3;
use crate::elementary::{sin_cos_turns, upper_angle};

/// Turns of one radian.
const TURNS: f32 = 0.5 * std::f32::consts::FRAC_1_PI;

/// A position relative to the place from which it is seen.
pub type Relative = [f64; 3];

/// The scalar product.
#[inline]
pub fn dot(a: Relative, b: Relative) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
#[inline]
pub fn cross(a: Relative, b: Relative) -> Relative {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// From one place to another.
#[inline]
pub fn between(from: Vec3, to: Vec3) -> Relative {
    [0, 1, 2].map(|axis| f64::from(to[axis]) - f64::from(from[axis]))
}

/// Sine and cosine of `radians` in [0, 2π], such that their squares add up to one in all digits of an `f64`.
#[inline]
fn sin_cos(radians: f32) -> (f64, f64) {
    let (sin, cos) = sin_cos_turns(radians * TURNS);
    let (sin, cos) = (f64::from(sin), f64::from(cos));
    // A step of Newton's method for one over the root.
    let scale = 1.5 - 0.5 * (sin * sin + cos * cos);
    (sin * scale, cos * scale)
}

/// A triangle as seen from the origin.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle {
    /// One over the distance of each corner.
    inverse: [f64; 3],
    /// Cosines of the sides ab, bc and ca.
    sides: [f64; 3],
    /// The triple product of the unit vectors to the corners.
    volume: f64,
    solid_angle: f32,
}

impl SphericalTriangle {
    /// The triangle abc. The origin must not be one of the corners.
    ///
    /// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 30(2), 1983.
    #[inline]
    pub fn new([a, b, c]: [Relative; 3]) -> Self {
        let [ra, rb, rc] = [a, b, c].map(|corner| dot(corner, corner).sqrt());
        let all = 1.0 / (ra * rb * rc);
        let inverse = [rb * rc * all, rc * ra * all, ra * rb * all];
        let sides = [dot(a, b) * rc * all, dot(b, c) * ra * all, dot(c, a) * rb * all];
        let volume = dot(a, cross(b, c)).abs() * all;
        let solid_angle = 2.0 * upper_angle(volume as f32, (1.0 + sides[0] + sides[1] + sides[2]) as f32);
        Self { inverse, sides, volume, solid_angle }
    }

    /// In sr, in [0, 2π].
    #[inline]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle
    }

    /// The barycentric coordinates of b and c of a point, uniform in solid angle.
    ///
    /// Arvo's construction ("Stratified Sampling of Spherical Triangles", SIGGRAPH 1995): u₀ cuts off a part of
    /// the triangle by an arc from b to a point p on ca, u₁ chooses a point on that arc. As in Peters, "BRDF
    /// Importance Sampling for Polygonal Lights" (SIGGRAPH 2021), p is the mirror image of a in a vector o
    /// that is linear in the sine and cosine of half the part's solid angle; and since every point is kept as a
    /// combination of a, b and c, its barycentric coordinates follow without intersecting anything.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        let [ab, bc, ca] = self.sides;
        let (sin, cos) = sin_cos(0.5 * u[0] * self.solid_angle);
        let o = (self.volume * cos - (bc + ca) * sin, (1.0 + ab) * sin);
        let inverse = 1.0 / (o.0 * o.0 + o.1 * o.1 + 2.0 * o.0 * o.1 * ca).max(f64::MIN_POSITIVE);
        let p = ((o.0 * o.0 - o.1 * o.1) * inverse, 2.0 * o.1 * (o.0 + o.1 * ca) * inverse);
        let bp = p.0 * ab + p.1 * bc;
        // 1 − cos is uniform along the arc, since a neighbouring arc meets it in b.
        let u1 = f64::from(u[1]);
        let z = 1.0 - u1 * (1.0 - bp);
        let along = (u1 * (1.0 + z) / (1.0 + bp).max(f64::MIN_POSITIVE)).max(0.0).sqrt();
        let weights = [along * p.0, z - along * bp, along * p.1];
        // Rounding can put a point beside the triangle, but hardly.
        let [a, b, c] = [0, 1, 2].map(|i| (weights[i] * self.inverse[i]).max(0.0));
        let scale = 1.0 / (a + b + c).max(f64::MIN_POSITIVE);
        [(b * scale) as f32, (c * scale) as f32]
    }
}

/// A rectangle as seen from the origin, in coordinates along its sides and across it.
///
/// Ureña, Fajardo and King, "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013. The part
/// of the rectangle up to x covers the solid angle F(x) − F(x₀) with F(x) = asin(c b₁) − asin(c b₀), where c, b₀ and
/// b₁ are the sines at which x, y₀ and y₁ are seen. All angles are carried as their sine and cosine, so that
/// no inverse function is needed.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    x: [f64; 2],
    y: [f64; 2],
    height: f64,
    /// Distances of the corners (x₀, y₀) and (x₀, y₁).
    distances: [f64; 2],
    solid_angle: f32,
}

impl SphericalRectangle {
    /// The rectangle that begins at `corner` and whose sides are that long, in the plane at distance
    /// `height`, which must not be zero.
    #[inline]
    pub fn new(corner: [f64; 2], size: [f64; 2], height: f64) -> Self {
        let (x, y) = ([corner[0], corner[0] + size[0]], [corner[1], corner[1] + size[1]]);
        let h2 = height * height;
        let (x2, y2) = (x.map(|x| x * x + h2), y.map(|y| y * y));
        let distance = |i: usize, j: usize| (x2[i] + y2[j]).sqrt();
        let [r00, r01, r10, r11] = [distance(0, 0), distance(0, 1), distance(1, 0), distance(1, 1)];
        // Two triangles on either side of a diagonal, as in `SphericalTriangle`: tan(Ω/2) of each is volume/d. The
        // product of the complex numbers d + i·volume has the sum of the angles.
        let volume = height * size[0] * size[1];
        let (xx, yy) = (x[0] * x[1] + h2, y[0] * y[1]);
        let diagonal = (xx + yy, r00 * r11);
        let d1 = (diagonal.0 + diagonal.1) * r10 + (xx + y2[0]) * r11 + (x2[1] + yy) * r00;
        let d2 = (diagonal.0 + diagonal.1) * r01 + (x2[0] + yy) * r11 + (xx + y2[1]) * r00;
        let scale = 1.0 / (diagonal.1 * diagonal.1 * r10 * r01);
        let (imaginary, real) = (volume * (d1 + d2) * scale, (d1 * d2 - volume * volume) * scale);
        let solid_angle = 2.0 * upper_angle(imaginary.max(0.0) as f32, real as f32);
        Self { x, y, height, distances: [r00, r01], solid_angle }
    }

    /// In sr, in [0, 2π].
    #[inline]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle
    }

    /// How far along the sides a point is from the corner, uniform in solid angle.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> [f64; 2] {
        let ([x0, x1], [y0, y1]) = (self.x, self.y);
        let x = self.column(u[0]).clamp(x0, x1);
        // The sine at which y is seen in the plane of its column is uniform.
        let d2 = x * x + self.height * self.height;
        let sine = |y: f64| y / (d2 + y * y).sqrt();
        let (low, high) = (sine(y0), sine(y1));
        let s = low + f64::from(u[1]) * (high - low);
        let y = (s * (d2 / (1.0 - s * s).max(f64::EPSILON)).sqrt()).clamp(y0, y1);
        [x - x0, y - y0]
    }

    /// The x up to which the rectangle covers the share `u` of its solid angle.
    #[inline]
    fn column(&self, u: f32) -> f64 {
        let ([x0, _], [y0, y1], h, [r00, r01]) = (self.x, self.y, self.height, self.distances);
        let (h2, x2) = (h * h, x0 * x0);
        let inverse = 1.0 / ((y0 * y0 + h2) * (y1 * y1 + h2)).sqrt();
        let yy = y0 * y1;
        // F(x₀), and σ = F(x₀) + uΩ.
        let scale = inverse / (x2 + h2);
        let first = (h * x0 * (y1 * r00 - y0 * r01) * scale, (h2 * r00 * r01 + x2 * yy) * scale);
        let part = sin_cos(u * self.solid_angle);
        let sin = first.0 * part.1 + first.1 * part.0;
        let cos = first.1 * part.1 - first.0 * part.0;
        // Solved for c: c² = sin²σ / (b₀² + b₁² − 2 b₀ b₁ cos σ). The tangent that belongs to it has the
        // denominator (cos σ − b₀ b₁)² − (1 − b₀²)(1 − b₁²).
        let (bb, kk) = (yy * inverse, h2 * inverse);
        let denominator = (cos - bb - kk) * (cos - bb + kk);
        // What lies beyond the horizon by rounding is clamped to the rectangle's end.
        h * sin / denominator.max(f64::MIN_POSITIVE).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;
    use proptest::prelude::*;

    fn unit(a: Relative) -> Relative {
        a.map(|x| x / dot(a, a).sqrt())
    }

    fn solid_angle(a: Relative, b: Relative, c: Relative) -> f64 {
        let (a, b, c) = (unit(a), unit(b), unit(c));
        2.0 * libm::atan2(dot(a, cross(b, c)).abs(), 1.0 + dot(a, b) + dot(b, c) + dot(c, a))
    }

    fn wide(v: Vec3) -> Relative {
        v.to_array().map(f64::from)
    }

    /// The solid angle of the part of a rectangle up to (x, y), as a share; and of the column at x up to y.
    fn parts([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], h: f64, [x, y]: [f64; 2]) -> [f64; 2] {
        let area = |x: f64, y: f64| libm::atan2(x * y, h * (x * x + y * y + h * h).sqrt());
        let strip = |x: f64| area(x, y1) - area(x, y0);
        let sine = |y: f64| y / (x * x + y * y + h * h).sqrt();
        [(strip(x) - strip(x0)) / (strip(x1) - strip(x0)), (sine(y) - sine(y0)) / (sine(y1) - sine(y0))]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        /// The share of the solid angle up to the sample is the random number, to what rounding allows.
        #[test]
        fn rectangles_keep_shares(
            (x0, y0) in (-3.0f32..2.0, -3.0f32..2.0),
            (width, log_h) in (0.02f32..1.0, -11.0f32..1.0),
            (u, v) in (0.0f32..1.0, 0.0f32..1.0),
        ) {
            let h = libm::expf(log_h);
            let r = SphericalRectangle::new([x0, y0].map(f64::from), [width, 1.0].map(f64::from), f64::from(h));
            let [a, b] = r.sample([u, v]);
            let [a, b] = [(a / f64::from(width)) as f32, b as f32];
            let [x, y] = [[x0, x0 + width], [y0, y0 + 1.0]].map(|e| e.map(f64::from));
            let exact = {
                let corner = |x: f64, y: f64| [x, y, f64::from(h)];
                let [p, q, s, t] =
                    [corner(x[0], y[0]), corner(x[1], y[0]), corner(x[1], y[1]), corner(x[0], y[1])];
                solid_angle(p, q, s) + solid_angle(p, s, t)
            };
            let omega = f64::from(r.solid_angle());
            prop_assert!((omega / exact - 1.0).abs() < 1e-4, "{omega} {exact}");
            prop_assert!((0.0..=1.0).contains(&a) && (0.0..=1.0).contains(&b));
            let at = [x[0] + (x[1] - x[0]) * f64::from(a), y[0] + (y[1] - y[0]) * f64::from(b)];
            let [found_u, found_v] = parts(x, y, f64::from(h), at);
            // Coordinates have 24 bits, of which a low place sees the last ones.
            let tolerance = 3e-6 + 3e-7 / f64::from(h);
            prop_assert!((found_u - f64::from(u)).abs() < tolerance, "{found_u} {u} {omega}");
            prop_assert!((found_v - f64::from(v)).abs() < tolerance, "{found_v} {v} {omega}");
        }

        /// The same of triangles, of any solid angle.
        #[test]
        fn triangles_keep_shares(
            corners in prop::array::uniform3(prop::array::uniform2(-2.0f32..2.0)),
            (log_h, log_size) in (-9.0f32..1.0, -7.0f32..3.0),
            (u, v) in (0.001f32..0.999, 0.001f32..0.999),
        ) {
            let (h, size) = (libm::expf(log_h), libm::expf(log_size));
            let corners = corners.map(|[x, y]| Vec3::new(x * size, y * size, h * size));
            let double_area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            prop_assume!(double_area > 0.02 * size * size);
            let t = SphericalTriangle::new(corners.map(wide));
            let [a, b, c] = corners.map(wide);
            let exact = solid_angle(a, b, c);
            let omega = f64::from(t.solid_angle());
            prop_assert!((omega / exact - 1.0).abs() < 1e-4, "{omega} {exact}");
            let [w1, w2] = t.sample([u, v]).map(f64::from);
            prop_assert!(w1 >= 0.0 && w2 >= 0.0 && w1 + w2 <= 1.0 + 1e-6);
            let at = [0, 1, 2].map(|i| a[i] * (1.0 - w1 - w2) + b[i] * w1 + c[i] * w2);
            // Where the arc from b through the point meets ca.
            let p = cross(cross(b, at), cross(c, a));
            let middle = [0, 1, 2].map(|i| unit(a)[i] + unit(c)[i]);
            let p = unit(p.map(|x| x * dot(p, middle).signum()));
            let found_u = solid_angle(a, b, p) / exact;
            let arc = |q: Relative| { let d = cross(unit(b), q); dot(d, d) / (1.0 + dot(unit(b), q)) };
            let found_v = arc(unit(at)) / arc(p);
            let tolerance = 1e-5 + 1e-6 / f64::from(h);
            prop_assert!((found_u - f64::from(u)).abs() < tolerance, "{found_u} {u} {omega}");
            prop_assert!((found_v - f64::from(v)).abs() < tolerance, "{found_v} {v} {omega}");
        }
    }

    #[test]
    fn known_solid_angles() {
        use std::f32::consts::PI;
        let octant = SphericalTriangle::new([Vec3::X, Vec3::Y, Vec3::Z * 3.0].map(wide));
        assert!((octant.solid_angle() - PI / 2.0).abs() < 1e-6);
        let face = SphericalRectangle::new([-1.0; 2], [2.0; 2], 1.0);
        assert!((face.solid_angle() - 4.0 * PI / 6.0).abs() < 1e-6);
        let all = SphericalRectangle::new([-1.0; 2], [2.0; 2], 1e-5);
        assert!((all.solid_angle() - 2.0 * PI).abs() < 1e-4);
        let far = SphericalRectangle::new([-0.5, 99.5], [1.0; 2], 0.1);
        assert!((far.solid_angle() - 1e-7).abs() < 1e-11);
    }
}
