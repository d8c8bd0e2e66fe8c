//! Scattering, worked out again from the formulas of smooth surfaces and the values of rough ones.

use caustica_math::Vec3;
use caustica_scene::bsdf::bump::MIRRORED;
use caustica_scene::bsdf::{Bsdf, Bump, Evaluated, Plastic};
use caustica_transport::vertex::Vertex;

use super::{Vector, distance, dot, lanes, narrow, plus, wide};

/// Scattering at a vertex: for a smooth surface coefficients of δ(to_light).
pub(super) struct Scattering {
    /// f·|cos_s|/|cos_g| with the cosines on the light's side.
    pub(super) value: Vector,
    pub(super) to_light_pdf: f64,
    pub(super) to_camera_pdf: f64,
    pub(super) smooth: bool,
    pub(super) uncertainty: f64,
}

impl Scattering {
    fn smooth(value: Vector, to_light_pdf: f64, to_camera_pdf: f64) -> Self {
        Self { value, to_light_pdf, to_camera_pdf, smooth: true, uncertainty: 0.0 }
    }
}

fn to_local(v: &Vertex, d: Vector) -> Vector {
    let f = v.point.frame;
    [dot(d, wide(f.x)), dot(d, wide(f.y)), dot(d, wide(f.z))]
}

/// Scattering at `v`, by a Dirac lobe or not, from the direction `to_light` into `to_camera`, which are known to within
/// `blurs`.
pub(super) fn scatter(
    (v, smooth): (&Vertex, bool),
    [to_light, to_camera]: [Vector; 2],
    blurs: [f64; 2],
) -> Result<Scattering, String> {
    let (light, camera, normal) = (to_local(v, to_light), to_local(v, to_camera), wide(v.point.normal));
    // Of a surface that counts as turned around, both normals are turned.
    let normal = normal.map(|c| c * f64::from(v.side(v.point.normal)).signum());
    let cos_g = dot(normal, to_light);
    if cos_g * light[2] <= 0.0 || dot(normal, to_camera) * camera[2] <= 0.0 {
        // Where a direction all but touches either surface, rounding decides.
        let touches = |cos: f64, local: Vector, blur: f64| cos.abs().min(local[2].abs()) < 4.0 * blur;
        if touches(cos_g, light, blurs[0]) || touches(dot(normal, to_camera), camera, blurs[1]) {
            return Ok(Scattering { uncertainty: f64::INFINITY, ..Scattering::smooth([0.0; 3], 0.0, 0.0) });
        }
        return Err("a direction is on different sides of the two normals".into());
    }
    let mut s = match v.bump() {
        Some(bump) if smooth => bumped(&v.bsdf, &bump, light, camera),
        Some(bump) => Ok(rough(|l, c| bump.eval(&v.bsdf, l, c), (light, camera), blurs[0] + blurs[1])),
        None if smooth => dirac(&v.bsdf, light, camera),
        None => Ok(rough(|l, c| v.bsdf.eval(l, c), (light, camera), blurs[0] + blurs[1])),
    }?;
    // The BSDF's cosines may be less than the surface's.
    let own = v.bump().map_or([light, camera], |bump| [light, camera].map(|d| in_frame(&bump, camera, d)));
    let cosines = [light[2].abs().min(own[0][2].abs()), camera[2].abs().min(own[1][2].abs())];
    // A refracted cosine follows from the other one, and Fresnel's equations from both.
    let shares = cosines.map(|cos| if s.smooth { cos * cos } else { cos });
    s.uncertainty += blurs[0] / shares[0] + blurs[1] / shares[1];
    s.value = s.value.map(|f| f / cos_g.abs());
    Ok(s)
}

/// Dirac lobes.
fn dirac(bsdf: &Bsdf, light: Vector, camera: Vector) -> Result<Scattering, String> {
    match bsdf {
        Bsdf::Mirror { reflectance } => mirror(lanes(*reflectance), light, camera),
        Bsdf::Conductor(b) => {
            let [eta, k, scale] = [b.eta, b.k, b.reflectance].map(lanes);
            let lane = |i: usize| scale[i] * fresnel(light[2], eta[i], k[i]);
            mirror([0, 1, 2].map(lane), light, camera)
        }
        Bsdf::Dielectric(b) => {
            let mut s = glass((b.interior_ior, b.exterior_ior), light, camera)?;
            let factor = if light[2] * camera[2] > 0.0 { b.reflectance } else { b.transmittance };
            (0..3).for_each(|lane| s.value[lane] *= lanes(factor)[lane]);
            Ok(s)
        }
        Bsdf::RoughDielectric(b) => glass(b.indices(), light, camera),
        Bsdf::Plastic(b) => coat(b, light, camera),
        Bsdf::ThinDielectric(b) => {
            let once = fresnel(light[2].abs(), f64::from(b.interior_ior) / f64::from(b.exterior_ior), 0.0);
            let reflected = 2.0 * once / (1.0 + once);
            let [reflectance, transmittance] = b.factors().map(lanes);
            if light[2] * camera[2] < 0.0 {
                straight(light, camera)?;
                let share = 1.0 - reflected;
                return Ok(Scattering::smooth(transmittance.map(|f| f * share), share, share));
            }
            let upper = |v: Vector| [v[0], v[1], v[2].abs()];
            mirror([1.0; 3], upper(light), upper(camera))?;
            Ok(Scattering::smooth(reflectance.map(|f| f * reflected), reflected, reflected))
        }
        Bsdf::Null => {
            straight(light, camera)?;
            Ok(Scattering::smooth([1.0; 3], 1.0, 1.0))
        }
        rough => Err(format!("{rough:?} is no Dirac lobe")),
    }
}

/// Light that is not refracted.
fn straight(light: Vector, camera: Vector) -> Result<(), String> {
    if distance(light, camera.map(|c| -c)) > SNELL {
        return Err(format!("light from {light:?} does not pass straight to {camera:?}"));
    }
    Ok(())
}

/// Dirac lobes about a normal that is not the surface's own. Light walks take that normal or its mirror image by chance.
fn bumped(bsdf: &Bsdf, bump: &Bump, light: Vector, camera: Vector) -> Result<Scattering, String> {
    let (n, mirrored) = (wide(bump.normal), is_mirrored(bump, camera));
    let (own_light, own_camera) = (in_frame(bump, camera, light), in_frame(bump, camera, camera));
    if own_light[2] * light[2] <= 0.0 || own_camera[2] * camera[2] <= 0.0 {
        return Err("a direction is on different sides of the two normals".into());
    }
    let mut s = dirac(bsdf, own_light, own_camera)?;
    let tan2 = |v: Vector| (v[0] * v[0] + v[1] * v[1]) / (v[2] * v[2]);
    let alpha2 = if bump.rule.shadows { (tan2(n) / 8.0).min(1.0) } else { 0.0 };
    s.value = s.value.map(|f| f * 2.0 / (1.0 + (1.0 + alpha2 * tan2(light)).sqrt()));
    s.to_camera_pdf *= if mirrored { f64::from(MIRRORED) } else { f64::from(bump.share(false)) };
    Ok(s)
}

/// Whether the normal is mirrored for light that goes to `camera`.
fn is_mirrored(bump: &Bump, camera: Vector) -> bool {
    bump.rule.flips && camera[2] * dot(camera, wide(bump.normal)) <= 0.0
}

/// A direction in the frame of the normal that counts for light that goes to `camera`.
fn in_frame(bump: &Bump, camera: Vector, direction: Vector) -> Vector {
    let f = bump.frame(is_mirrored(bump, camera));
    [f.x, f.y, f.z].map(|axis| dot(direction, wide(axis)))
}

/// All that is not Dirac. How well it is known shows when a direction changes a little.
fn rough(f: impl Fn(Vec3, Vec3) -> Evaluated, (light, camera): (Vector, Vector), blur: f64) -> Scattering {
    let eval = |x: f64, y: f64| {
        let e = f(narrow(light), narrow(plus(camera, [x, y, 0.0], blur)));
        let [r, g, b] = lanes(e.value);
        [r, g, b, e.to_light_pdf.get().into(), e.to_camera_pdf.get().into()]
    };
    let figures = eval(0.0, 0.0);
    let changes = [eval(1.0, 1.0), eval(1.0, -1.0)]
        .map(|other| (0..5).map(|i| (other[i] - figures[i]).abs() / figures[i].abs()).fold(0.0, f64::max));
    let [r, g, b, to_light_pdf, to_camera_pdf] = figures;
    let uncertainty = 2.0 * changes[0].max(changes[1]);
    Scattering { value: [r, g, b], to_light_pdf, to_camera_pdf, smooth: false, uncertainty }
}

/// How far a smooth surface's directions may be off, by rounding.
const SNELL: f64 = 1e-3;

/// Mirroring keeps solid angles: all three coefficients are the reflectance or one.
fn mirror(reflectance: Vector, light: Vector, camera: Vector) -> Result<Scattering, String> {
    if distance(light, [-camera[0], -camera[1], camera[2]]) > SNELL || light[2] <= 0.0 {
        return Err(format!("a mirror sends {light:?} to {camera:?}"));
    }
    Ok(Scattering::smooth(reflectance, 1.0, 1.0))
}

/// The Dirac lobe of plastic: Fresnel's reflectance, and the probability that it is chosen.
fn coat(b: &Plastic, light: Vector, camera: Vector) -> Result<Scattering, String> {
    let (fresnel, share) = (fresnel(light[2], b.eta().into(), 0.0), f64::from(b.coat_share()));
    let mut s = mirror(lanes(b.specular()).map(|factor| factor * fresnel), light, camera)?;
    let probability = fresnel * share / (fresnel * share + (1.0 - fresnel) * (1.0 - share));
    (s.to_light_pdf, s.to_camera_pdf) = (probability, probability);
    Ok(s)
}

/// The two Dirac lobes of a smooth interface.
///
/// Refracted radiance is T·(n_c/n_l)²·L, so that f·|cos| = T·(n_c/n_l)²·δ(to_light). The light walk refracts with
/// density T·δ(to_camera), and n²·|cos|·dω is the same on both sides, so that
/// δ(to_camera) = δ(to_light)·dω_l/dω_c = δ(to_light)·(n_c/n_l)²·|cos_c|/|cos_l|.
fn glass((interior, exterior): (f32, f32), light: Vector, camera: Vector) -> Result<Scattering, String> {
    let index = |v: Vector| f64::from(if v[2] > 0.0 { exterior } else { interior });
    let (n_light, n_camera) = (index(light), index(camera));
    let beyond = f64::from(exterior) + f64::from(interior) - n_light;
    let reflectance = fresnel(light[2].abs(), beyond / n_light, 0.0);
    if light[2] * camera[2] > 0.0 {
        let upper = |v: Vector| [v[0], v[1], v[2].abs()];
        mirror([reflectance; 3], upper(light), upper(camera))?;
        return Ok(Scattering::smooth([reflectance; 3], reflectance, reflectance));
    }
    let tangent = |axis: usize| n_light * light[axis] + n_camera * camera[axis];
    if tangent(0).hypot(tangent(1)) > SNELL {
        return Err(format!("glass refracts {light:?} to {camera:?}"));
    }
    let (share, scale) = (1.0 - reflectance, (n_camera / n_light).powi(2));
    Ok(Scattering::smooth([share * scale; 3], share, share * scale * (camera[2] / light[2]).abs()))
}

/// Fresnel's equations for unpolarised light, for an index `eta` + i·`k` relative to the medium around.
fn fresnel(cos: f64, eta: f64, k: f64) -> f64 {
    let square = [eta * eta - k * k, 2.0 * eta * k];
    // w = √(index² − sin²), the refracted wave's cosine times its index.
    let (re, im) = (square[0] - (1.0 - cos * cos), square[1]);
    let modulus = re.hypot(im);
    let w = [(0.5 * (modulus + re)).max(0.0).sqrt(), (0.5 * (modulus - re)).max(0.0).sqrt()];
    let share = |a: [f64; 2]| {
        let norm = |sign: f64| (a[0] + sign * w[0]).powi(2) + (a[1] + sign * w[1]).powi(2);
        norm(-1.0) / norm(1.0)
    };
    0.5 * (share([cos, 0.0]) + share(square.map(|c| c * cos)))
}
