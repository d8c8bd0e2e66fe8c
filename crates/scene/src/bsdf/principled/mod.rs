//! Disney's principled surfaces, as Mitsuba documents them: `principled` and `principledthin`.
//!
//! Burley, "Physically Based Shading at Disney", SIGGRAPH 2012 course notes, and "Extending the Disney BRDF to a BSDF with
//! Integrated Subsurface Scattering", 2015. Lobes are added up without regard to the energy that others take.

mod lobes;
mod solid;
mod thin;

pub use solid::Principled;
pub use thin::PrincipledThin;
