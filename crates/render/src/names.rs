use caustica_math::Rgb;
use caustica_scene::description::{Integrator, Technique};

/// The names by which integrators are chosen, with what each does.
pub const INTEGRATOR_NAMES: &[(&str, &str)] = &[
    ("bdpt", "bidirectional path tracing, with a light image"),
    ("path", "unidirectional path tracing, materials and emitters by MIS (= path_mis)"),
    ("path_ems", "unidirectional path tracing, emitter sampling"),
    ("naive", "unidirectional path tracing, material sampling only (= path_mats)"),
    ("light", "light tracing into the light image"),
    ("direct", "emitted and direct light by MIS (= direct_mis)"),
    ("direct_ems", "emitted and direct light by emitter sampling"),
    ("direct_mats", "emitted and direct light by material sampling"),
    ("whitted", "direct light and chains of mirrors and glass"),
    ("ao", "ambient occlusion"),
    ("av", "average visibility within a tenth of the scene's size"),
    ("normals", "absolute shading normals"),
    ("depth", "distance from the camera"),
    ("simple", "Nori's point light without materials, at the camera"),
    ("directional", "local shading under one directional light from the camera, with shadows"),
];

/// The integrator of that name. Those with parameters get ones that suit any scene: the scene file can say
/// otherwise. `extent` is the size of the scene, `eye` the camera's place and `forward` its direction.
pub fn integrator_by_name(name: &str, extent: f32, eye: [f32; 3], forward: [f32; 3]) -> Option<Integrator> {
    use Technique::{Emitters, Materials, Mis};
    Some(match name {
        "bdpt" => Integrator::Bdpt,
        "path" | "path_mis" => Integrator::Path(Mis),
        "path_ems" => Integrator::Path(Emitters),
        "naive" | "path_mats" => Integrator::Path(Materials),
        "light" => Integrator::Light,
        "direct" | "direct_mis" => Integrator::Direct(Mis),
        "direct_ems" => Integrator::Direct(Emitters),
        "direct_mats" => Integrator::Direct(Materials),
        "whitted" => Integrator::Whitted,
        "ao" => Integrator::Ao,
        "av" => Integrator::Av { length: extent * 0.1 },
        "normals" => Integrator::Normals,
        "depth" => Integrator::Depth,
        "simple" => {
            // Bright enough to see: radiance about one at the scene's distance.
            let energy = Rgb::splat(4.0 * std::f32::consts::PI * std::f32::consts::PI * extent * extent);
            Integrator::Simple { position: eye, energy }
        }
        "directional" => {
            Integrator::Directional { direction: forward, irradiance: Rgb::splat(std::f32::consts::PI) }
        }
        _ => return None,
    })
}

/// The name of an integrator.
pub fn integrator_name(integrator: &Integrator) -> &'static str {
    match integrator {
        Integrator::Bdpt => "bdpt",
        Integrator::Path(Technique::Mis) => "path",
        Integrator::Path(Technique::Emitters) => "path_ems",
        Integrator::Path(Technique::Materials) => "naive",
        Integrator::Light => "light",
        Integrator::Direct(Technique::Mis) => "direct",
        Integrator::Direct(Technique::Emitters) => "direct_ems",
        Integrator::Direct(Technique::Materials) => "direct_mats",
        Integrator::Whitted => "whitted",
        Integrator::Ao => "ao",
        Integrator::Av { .. } => "av",
        Integrator::Normals => "normals",
        Integrator::Depth => "depth",
        Integrator::Simple { .. } => "simple",
        Integrator::Directional { .. } => "directional",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_names_its_integrator() {
        for (name, _) in INTEGRATOR_NAMES {
            let made = integrator_by_name(name, 1.0, [0.0; 3], [0.0, 0.0, 1.0]).expect(name);
            assert_eq!(integrator_name(&made), *name);
        }
        assert!(integrator_by_name("photon", 1.0, [0.0; 3], [0.0; 3]).is_none());
    }
}
