//! Faults that tests plant, to see that they are found. Only with the feature `planted-fault`, which is for tests
//! alone; without it nothing here costs anything, and nothing is ever wrong.

#[cfg(feature = "planted-fault")]
use std::sync::atomic::{AtomicU8, Ordering};

/// What can be made wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Light walks forget the ratio of cosines that makes scattering the same both ways, where they go on and where
    /// they are joined.
    Adjoint,
    /// The two densities of scattering are mixed up in the weights of eye walks, where they go on and where they are
    /// joined. (In those of both walks it would change no mean: weights would still add up to one.)
    SwappedDensities,
    /// Hits are weighed as if next-event estimation were half as likely as it is.
    NextEventDensity,
    /// Weights of the light image forget how many light paths a pass has.
    LightPaths,
    /// What survives roulette does not make up for what did not.
    Roulette,
    /// Next-event estimation forgets the cosine at the lamp.
    LampCosine,
    /// Edges from infinity get the jacobian of an edge of two metres.
    InfinityJacobian,
}

#[cfg(feature = "planted-fault")]
impl Fault {
    /// All of them, with the names by which they are chosen.
    pub const ALL: [(&'static str, Self); 7] = [
        ("adjoint", Self::Adjoint),
        ("swapped-densities", Self::SwappedDensities),
        ("next-event-density", Self::NextEventDensity),
        ("light-paths", Self::LightPaths),
        ("roulette", Self::Roulette),
        ("lamp-cosine", Self::LampCosine),
        ("infinity-jacobian", Self::InfinityJacobian),
    ];
}

/// The fault that is planted, by its number from one; zero for none.
#[cfg(feature = "planted-fault")]
static PLANTED: AtomicU8 = AtomicU8::new(0);

/// Plants a fault in the whole process, or takes it out. Not while anything is rendered.
#[cfg(feature = "planted-fault")]
pub fn plant(fault: Option<Fault>) {
    PLANTED.store(fault.map_or(0, |f| f as u8 + 1), Ordering::SeqCst);
}

/// Plants the fault that the environment variable `CAUSTICA_FAULT` names; none without it, or by another name.
#[cfg(feature = "planted-fault")]
pub fn plant_from_environment() {
    let name = std::env::var("CAUSTICA_FAULT").unwrap_or_default();
    plant(Fault::ALL.iter().find(|(n, _)| *n == name).map(|(_, fault)| *fault));
}

/// Whether that fault is planted.
#[cfg(feature = "planted-fault")]
#[inline]
pub(crate) fn is_planted(fault: Fault) -> bool {
    PLANTED.load(Ordering::Relaxed) == fault as u8 + 1
}

/// Whether that fault is planted: never.
#[cfg(not(feature = "planted-fault"))]
#[inline(always)]
pub(crate) fn is_planted(_: Fault) -> bool {
    false
}
