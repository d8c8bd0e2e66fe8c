//! Densities whose measure stands in their type.
//!
//! A bare `f32` cannot say whether it is per steradian or per square metre; most bugs of bidirectional
//! renderers are a conversion that was forgotten or done twice. The one conversion between the two
//! measures is done where edges are known, in the transport crate.

use std::ops::Mul;

macro_rules! density {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
        #[repr(transparent)]
        pub struct $name(pub f32);

        impl $name {
            /// The density that is zero everywhere.
            pub const ZERO: Self = Self(0.0);
            /// The bare number.
            #[inline]
            pub const fn get(self) -> f32 {
                self.0
            }
        }

        impl Mul<Mass> for $name {
            type Output = $name;
            #[inline]
            fn mul(self, m: Mass) -> $name {
                $name(self.0 * m.0)
            }
        }
    };
}

density! {
    /// A density per unit solid angle, in sr⁻¹.
    SolidAnglePdf
}

density! {
    /// A density in a vertex's own measure: per unit area (m⁻²) for a vertex at a finite place, per
    /// unit solid angle (sr⁻¹) for a vertex at infinity, and a plain probability for a vertex whose
    /// place or direction is fixed by a Dirac distribution.
    AreaPdf
}

density! {
    /// A discrete probability: of choosing a lamp, a lobe, or to go on.
    Mass
}

impl Mass {
    /// Certainty.
    pub const ONE: Self = Self(1.0);
}
