use std::f32::consts::{FRAC_PI_2, PI};

use caustica_math::elementary::{asin, pow, safe_sqrt, sin, sin_cos_turns};
use caustica_math::{Frame, Rgb, SolidAnglePdf, Vec3, warp};

use super::{Figures, Heaven, WHOLE_Y, turbidity_between};

static FIGURES: Figures = Figures(include_bytes!("../../../data/daylight/sun.f32"));

/// Pieces of the elevation: the ends are at π/2·(i/45)³.
const PIECES: usize = 45;
const WAVELENGTHS: usize = 11;
/// Coefficients of the elevation.
const POWERS: usize = 4;
const BLOCK: usize = PIECES * WAVELENGTHS * POWERS;

/// The sun's diameter as it is seen, in degrees: the one for which the figures are.
pub const SUN_DIAMETER: f32 = 0.5358;

/// Narrower suns are refused, in degrees: their directions are told apart by too few bits.
pub const LEAST_APERTURE: f32 = 0.01;

/// A direction that was chosen inside of the disc may lie outside of it, after rounding, by so much.
const ROUNDING: f32 = 2.5e-7;

/// For 320 to 720 nm, every 40 nm: how the sun darkens from its middle (1) to its edge (0), as a polynomial in the cosine
/// of the angle between the ray and the sun's normal. As published with the model of 2013.
#[rustfmt::skip]
const DARKENING: [[f32; 6]; WAVELENGTHS] = [
    [0.087657, 0.767174, 0.658123, -1.02953, 0.703297, -0.186735],
    [0.122953, 1.01278, 0.238687, -1.12208, 1.17087, -0.424947],
    [0.123511, 1.08444, -0.405598, 0.370629, -0.240567, 0.0674778],
    [0.158489, 1.23346, -0.875754, 0.857812, -0.484919, 0.110895],
    [0.198587, 1.30507, -1.25998, 1.49727, -1.04047, 0.299516],
    [0.23695, 1.29927, -1.28034, 1.3776, -0.85054, 0.21706],
    [0.26892, 1.34319, -1.58427, 1.91271, -1.3135, 0.37295],
    [0.299804, 1.36718, -1.80884, 2.29294, -1.60595, 0.454874],
    [0.33551, 1.30791, -1.79382, 2.44646, -1.89082, 0.594769],
    [0.364007, 1.27316, -1.73824, 2.28535, -1.70203, 0.517758],
    [0.389704, 1.2448, -1.69708, 2.14061, -1.51803, 0.440004],
];

/// The standard observer of CIE 1931 at the same wavelengths, in linear BT.709.
#[rustfmt::skip]
const OBSERVER: [[f32; 3]; WAVELENGTHS] = [
    [0.0, 0.0, 0.0],
    [0.000112755, -0.0000933710, 0.000647266],
    [0.0119369, -0.0103076, 0.0724541],
    [0.222269, -0.221824, 1.86187],
    [-0.309059, 0.201884, 0.836497],
    [-0.925362, 1.27388, -0.0586151],
    [0.395056, 1.29055, -0.165817],
    [2.47170, 0.154240, -0.0687960],
    [1.18240, -0.105831, -0.0107616],
    [0.125426, -0.0134403, -0.000866074],
    [0.00778475, -0.000845711, -0.0000523095],
];

/// How many nm each wavelength stands for: not quite 40, but what Mitsuba takes, whose suns are this one.
const WIDTH: f32 = 467.069_28 / WAVELENGTHS as f32;

/// The radiance of a piece: of each channel, for each power of the elevation (from the piece's beginning), each power of
/// the cosine at the sun's surface.
type Piece = [[[f32; 6]; POWERS]; 3];

/// The sun: a disc at infinity. What of it is below the horizon is black.
#[derive(Debug)]
pub struct SunLight {
    to_sun: Vec3,
    up: Vec3,
    frame: Frame,
    disc: Disc,
    surface: Surface,
    flux: f64,
    brightest: f32,
}

/// How large it is, by 1 − cos of its half angle: cosines of narrow cones all round to one.
#[derive(Clone, Copy, Debug)]
struct Disc {
    edge: f32,
    /// The same of the disc on which directions from inside of the edge may lie after rounding. This is the disc that is
    /// seen, and that gives the irradiance.
    end: f32,
    /// The sine of the half angle.
    sin: f32,
}

#[derive(Debug)]
enum Surface {
    /// The same radiance everywhere.
    Even(Rgb),
    /// Darker towards its edge and the horizon, in the sky's frame.
    Darkened(Box<[Piece; PIECES]>),
}

impl Disc {
    fn new(aperture: f32) -> Self {
        let half = 0.5 * aperture.to_radians();
        let s = sin(0.5 * half);
        let end = 2.0 * s + ROUNDING;
        Self { edge: 2.0 * s * s, end: 0.5 * end * end, sin: sin(half) }
    }

    /// The cosine between a ray and the sun's surface, by 1 − cos of the ray's angle with the sun's middle.
    fn cos_at_surface(&self, one_minus_cos: f32) -> f32 {
        let sin2 = one_minus_cos * (2.0 - one_minus_cos);
        safe_sqrt(1.0 - sin2 / (self.sin * self.sin))
    }
}

impl SunLight {
    /// Bytes of its table.
    pub const TABLE: u64 = size_of::<[Piece; PIECES]>() as u64;

    /// A sun of that diameter in degrees, from [`LEAST_APERTURE`] to 180. All of them give the same irradiance.
    pub fn new(heaven: &Heaven, aperture: f32, scale: f32, darkened: bool) -> Self {
        let disc = Disc::new(aperture);
        let surface = if darkened {
            let smaller = Disc::new(SUN_DIAMETER).edge / disc.end;
            Surface::Darkened(pieces(heaven.turbidity, scale * smaller))
        } else {
            let irradiance = irradiance(&pieces(heaven.turbidity, scale), heaven.elevation());
            Surface::Even(clipped(irradiance) * (1.0 / (2.0 * PI * disc.end)))
        };
        let (to_sun, up) = (heaven.to_sun, heaven.axes[2]);
        let mut sun =
            Self { to_sun, up, frame: Frame::from_normal(to_sun), disc, surface, flux: 0.0, brightest: 0.0 };
        sun.measure();
        sun
    }

    /// ∫ luminance dω, by many looks.
    pub fn flux(&self) -> f64 {
        self.flux
    }

    /// A bound of its radiance.
    pub fn brightest(&self) -> f32 {
        self.brightest
    }

    fn measure(&mut self) {
        let n = 64;
        let mut sum = 0.0;
        for look in 0..n * n {
            let u = [look % n, look / n].map(|k| (k as f32 + 0.5) / n as f32);
            let radiance = self.radiance_from(self.sample_direction(u).0);
            sum += f64::from(radiance.luminance());
            self.brightest = self.brightest.max(1.1 * radiance.max_channel());
        }
        self.flux = sum / f64::from(n * n) * 2.0 * std::f64::consts::PI * f64::from(self.disc.end);
    }

    /// 1 − cos between a direction and the sun's middle, without the cancellation of that difference.
    #[inline]
    fn one_minus_cos(&self, towards: Vec3) -> f32 {
        0.5 * (towards - self.to_sun).length_squared()
    }

    /// A direction of the disc, uniform but for rounding, and its density.
    pub fn sample_direction(&self, u: [f32; 2]) -> (Vec3, SolidAnglePdf) {
        let towards = self.frame.to_world(warp::uniform_cone(u, self.disc.edge));
        (towards, warp::uniform_cone_pdf(self.disc.end))
    }

    /// The density of a direction.
    #[inline]
    pub fn direction_pdf(&self, towards: Vec3) -> SolidAnglePdf {
        if self.one_minus_cos(towards) > self.disc.end {
            return SolidAnglePdf::ZERO;
        }
        warp::uniform_cone_pdf(self.disc.end)
    }

    /// The radiance that arrives from a direction.
    #[inline]
    pub fn radiance_from(&self, towards: Vec3) -> Rgb {
        let h = self.one_minus_cos(towards);
        if h > self.disc.end {
            return Rgb::BLACK;
        }
        let z = towards.dot(self.up);
        match &self.surface {
            _ if z < 0.0 => Rgb::BLACK,
            Surface::Even(radiance) => *radiance,
            Surface::Darkened(pieces) => clipped(radiance(pieces, asin(z), self.disc.cos_at_surface(h))),
        }
    }
}

/// The beginning of a piece, in radians.
fn beginning(piece: usize) -> f32 {
    let part = piece as f32 / PIECES as f32;
    FRAC_PI_2 * part * part * part
}

/// The radiance of the disc at an elevation (rad), where the ray has that cosine with the sun's surface. A sun of deep red
/// has a little less than no blue.
fn radiance(pieces: &[Piece; PIECES], elevation: f32, cos: f32) -> Rgb {
    let index = (pow(elevation / FRAC_PI_2, 1.0 / 3.0) * PIECES as f32) as usize;
    let index = index.min(PIECES - 1);
    let x = elevation - beginning(index);
    Rgb(pieces[index].map(|powers| {
        let at = |c: [f32; 6]| c.into_iter().rev().fold(0.0, |sum, c| sum * cos + c);
        powers.into_iter().rev().fold(0.0, |sum, c| sum * x + at(c))
    }))
}

/// To what BT.709 can show.
fn clipped(colour: Rgb) -> Rgb {
    colour.map(|c| c.max(0.0))
}

/// What the figures say for a turbidity, in colours.
fn pieces(turbidity: f32, scale: f32) -> Box<[Piece; PIECES]> {
    let turbidity = turbidity_between(turbidity);
    let scale = f64::from(scale * WIDTH / WHOLE_Y);
    let mut all = Box::new([[[[0.0; 6]; POWERS]; 3]; PIECES]);
    for (index, piece) in all.iter_mut().enumerate() {
        for (channel, powers) in piece.iter_mut().enumerate() {
            for (k, cosines) in powers.iter_mut().enumerate() {
                for (j, number) in cosines.iter_mut().enumerate() {
                    let of = |l: usize| {
                        let i = (index * WAVELENGTHS + l) * POWERS + k;
                        let middle = f64::from(FIGURES.between(turbidity, BLOCK, i));
                        middle * f64::from(DARKENING[l][j]) * f64::from(OBSERVER[l][channel])
                    };
                    *number = ((0..WAVELENGTHS).map(of).sum::<f64>() * scale) as f32;
                }
            }
        }
    }
    all
}

/// The irradiance of the sun as Mitsuba has it: along straight lines from every third degree to the next, from 2° on.
fn irradiance(pieces: &[Piece; PIECES], elevation: f32) -> Rgb {
    let at = ((elevation.to_degrees() - 2.0) / 3.0).clamp(0.0, 29.0);
    let low = (at as usize).min(28);
    let [a, b] = [low, low + 1].map(|i| over_disc(pieces, (2.0 + 3.0 * i as f32).to_radians()));
    a * (1.0 - (at - low as f32)) + b * (at - low as f32)
}

/// ∫ radiance dω over a sun of the usual size whose middle has that elevation.
fn over_disc(pieces: &[Piece; PIECES], elevation: f32) -> Rgb {
    let disc = Disc::new(SUN_DIAMETER);
    // With the cosine μ at the sun's surface, a ring is proportional to 2μ dμ, and the radiance a polynomial in μ: exact
    // by four of Gauss's points.
    const POINTS: [(f32, f32); 4] = [
        (0.069_431_84, 0.173_927_42),
        (0.330_009_5, 0.326_072_58),
        (0.669_990_54, 0.326_072_58),
        (0.930_568_16, 0.173_927_42),
    ];
    let (turns, mut sum) = (8, Rgb::BLACK);
    for (mu, weight) in POINTS {
        let from_middle = disc.sin * (1.0 - mu * mu).sqrt();
        for turn in 0..turns {
            let (upwards, _) = sin_cos_turns((turn as f32 + 0.5) / turns as f32);
            let here = radiance(pieces, (elevation + from_middle * upwards).min(FRAC_PI_2), mu);
            sum = sum + here * (weight * 2.0 * mu / turns as f32);
        }
    }
    sum * (2.0 * PI * disc.edge)
}
