//! Wrappers opened: which BSDF a vertex has, and how it lies there.
//!
//! What is several materials at once is one of them at each vertex, by a chance that depends on the place alone.

use caustica_math::{Frame, Rgb, Vec3, Wavelengths};

use crate::bsdf::{Bsdf, Bump};
use crate::description::{BumpRule, MaterialKind, Texture, Wrapper};
use crate::material::bsdf_at;
use crate::scene::Scene;
use crate::surface::SurfacePoint;
use crate::texture::grey;

/// A normal map's least cosine to the surface's own normal.
const LEAST_COS: f32 = 1e-3;

/// A BSDF in its place.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// The BSDF.
    pub bsdf: Bsdf,
    /// Whether the surface counts as turned around, with the z axis of its shading frame.
    pub turned: bool,
    /// The normal that the BSDF has, if it is not the surface's own.
    pub bump: Option<Bump>,
}

impl Scene {
    /// Opens the wrappers of a point's material, seen from the direction `prev`. `label` is uniform in [0, 1) and decides
    /// what the vertex is where chance decides.
    #[inline(never)]
    pub fn placed(&self, point: &SurfacePoint, prev: Vec3, label: f64, w: Wavelengths) -> Placed {
        let (textures, mut label) = (self.textures_at(point), label);
        let mut chance = |share: f32| {
            let share = f64::from(share);
            let hit = label < share;
            // What is left of the number is uniform again.
            label = if hit { label / share } else { (label - share) / (1.0 - share) };
            hit
        };
        let share = |texture: &Texture| grey(textures.rgb(texture, point.uv)).clamp(0.0, 1.0);
        let mut placed = Placed { bsdf: Bsdf::Null, turned: false, bump: None };
        let mut material = self.material(self.surfaces().shapes[point.shape as usize].material);
        loop {
            let MaterialKind::Wrapped(wrapper) = &material.kind else {
                placed.bsdf = bsdf_at(material, &textures, point.uv, w);
                return placed;
            };
            let inner = match wrapper {
                Wrapper::Mask { opacity, inner } => {
                    if !chance(share(opacity)) {
                        return placed;
                    }
                    *inner
                }
                Wrapper::Blend { weight, inner: [first, second] } => {
                    if chance(share(weight)) {
                        *second
                    } else {
                        *first
                    }
                }
                Wrapper::TwoSided { front, back } => {
                    let in_front = (point.normal.dot(prev) >= 0.0) ^ placed.turned;
                    if !in_front {
                        placed.turn();
                    }
                    if in_front { *front } else { *back }
                }
                Wrapper::Bump { height, scale, rule, inner } => {
                    let slope = textures.gradient(height, point.uv).map(|g| g * scale);
                    placed.lean(self.raised(point, slope), *rule);
                    *inner
                }
                Wrapper::NormalMap { normals, rule, inner } => {
                    let Rgb([x, y, z]) = textures.rgb(normals, point.uv) * 2.0;
                    placed.lean(Vec3::new(x - 1.0, y - 1.0, z - 1.0), *rule);
                    *inner
                }
            };
            material = self.material(inner.0);
        }
    }

    /// The normal, in the shading frame, of a surface that is raised by a height of those derivatives by u and v.
    ///
    /// Blinn, "Simulation of wrinkled surfaces", 1978.
    fn raised(&self, point: &SurfacePoint, slope: [f32; 2]) -> Vec3 {
        let Frame { x, y, .. } = point.frame;
        let tangents = self.surfaces().derivatives(point).unwrap_or([x, y]);
        let [p, q] = [0, 1].map(|i| {
            let t = point.frame.to_local(tangents[i]);
            Vec3::new(t.x, t.y, slope[i])
        });
        let normal = p.cross(q);
        if normal.z < 0.0 { -normal } else { normal }
    }
}

impl Placed {
    fn turn(&mut self) {
        self.turned = !self.turned;
        if let Some(bump) = &mut self.bump {
            // Turned with the surface, and told in the turned frame.
            bump.normal = Vec3::new(-bump.normal.x, -bump.normal.y, bump.normal.z);
        }
    }

    /// Gives the BSDF a normal, of any length, in the frame that it has so far.
    fn lean(&mut self, normal: Vec3, rule: BumpRule) {
        let normal = normal.try_normalized().unwrap_or(Vec3::Z);
        let normal = self.bump.map_or(normal, |b| b.frame(false).to_world(normal));
        let normal = Vec3::new(normal.x, normal.y, normal.z.max(LEAST_COS)).normalized();
        self.bump = Some(Bump { normal, rule });
    }
}
