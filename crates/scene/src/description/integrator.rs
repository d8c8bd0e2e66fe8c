use caustica_math::Rgb;
use serde::{Deserialize, Serialize};

/// Which sampling techniques a direct-light or path integrator uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Technique {
    /// Material sampling only: light is found by hitting lamps.
    Materials,
    /// Emitter sampling only (next-event estimation), with hits where it cannot reach.
    Emitters,
    /// Both, weighed by multiple importance sampling.
    Mis,
}

/// The algorithm that a scene asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Integrator {
    /// The absolute value of the shading normal's coordinates, as a colour.
    Normals,
    /// Distance from the camera along the ray.
    Depth,
    /// Ambient occlusion: the cosine-weighted part of the hemisphere that is open.
    Ao,
    /// Average visibility: the part of the hemisphere that is open up to a length.
    Av {
        /// Length of the test rays.
        length: f32,
    },
    /// A point light without materials: Φ/(4π²)·cos θ/d²·V.
    Simple {
        /// Where the light is.
        position: [f32; 3],
        /// Its energy Φ.
        energy: Rgb,
    },
    /// Local shading under one directional light, with shadows.
    Directional {
        /// The direction in which the light travels.
        direction: [f32; 3],
        /// Its irradiance on a surface that faces it.
        irradiance: Rgb,
    },
    /// Emitted and direct light only.
    Direct(Technique),
    /// Direct light and chains of mirrors and glass.
    Whitted,
    /// Unidirectional path tracing.
    Path(Technique),
    /// Light tracing alone, into the light image.
    Light,
    /// Bidirectional path tracing.
    #[default]
    Bdpt,
}
