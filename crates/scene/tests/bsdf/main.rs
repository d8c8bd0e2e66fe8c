//! Surfaces: χ², energy, identities and others' figures. One program, so that it is linked once.

mod bumps;
mod chi_square;
mod energy;
mod figures;
mod identities;
mod mitsuba;
mod registry;
