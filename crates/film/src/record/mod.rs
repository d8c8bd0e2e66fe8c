//! Films with what they are films of, in files that can be merged and continued.

mod file;
mod ranges;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use file::write_film;
pub use ranges::SampleRanges;

use crate::FilmError;
use crate::dual::DualFilm;

/// What a film is a film of. Films of the same can be merged.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Provenance {
    /// The scene's name, for people: the same scene may lie in files of different names.
    pub scene: String,
    /// A hash of all that the scene holds.
    pub scene_hash: String,
    /// All else that a sample depends on, by name: integrator, seed, version and so on.
    pub settings: BTreeMap<String, String>,
}

impl Provenance {
    /// What differs, such as `the seed (1 and 2)`; `None` if both are the same but for the scene's name.
    pub fn difference(&self, other: &Self) -> Option<String> {
        if self.scene_hash != other.scene_hash {
            return Some(if self.scene == other.scene {
                format!("what `{}` holds", self.scene)
            } else {
                format!("the scene (`{}` and `{}`)", self.scene, other.scene)
            });
        }
        let names: std::collections::BTreeSet<_> =
            self.settings.keys().chain(other.settings.keys()).collect();
        let differs = names.into_iter().find(|n| self.settings.get(*n) != other.settings.get(*n))?;
        let shown = |p: &Self| p.settings.get(differs).cloned().unwrap_or_else(|| "not set".to_owned());
        Some(format!("the {differs} ({} and {})", shown(self), shown(other)))
    }
}

/// What is known of a film.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FilmFacts {
    /// What it is a film of.
    pub provenance: Provenance,
    /// The samples that it holds.
    pub samples: SampleRanges,
    /// Seconds of rendering.
    pub seconds: f64,
}

/// A film and what is known of it: all that is needed to merge it with others and to continue it.
#[derive(Debug)]
pub struct FilmRecord {
    /// The sums.
    pub film: DualFilm,
    /// What they are sums of.
    pub facts: FilmFacts,
}

impl FilmRecord {
    /// Whether the other can be added to this one.
    ///
    /// # Errors
    /// If it is a film of another scene, another size or other settings, or if both hold the same samples.
    pub fn check_mergeable(&self, other: &Self) -> Result<(), FilmError> {
        let (ours, theirs) = (&self.facts, &other.facts);
        if let Some(what) = ours.provenance.difference(&theirs.provenance) {
            return Err(FilmError::Merge(format!("they differ in {what}")));
        }
        if let Some(twice) = ours.samples.overlap(&theirs.samples) {
            return Err(FilmError::Merge(format!("both hold the samples {}..{}", twice.start, twice.end)));
        }
        self.film.halves()[0].check_same_layout(&other.film.halves()[0])
    }

    /// Adds another film. The bits of the sum do not depend on the order or the grouping in which films are merged,
    /// and are those of a film that was rendered at once.
    ///
    /// # Errors
    /// Those of [`FilmRecord::check_mergeable`]; then this one stays as it is.
    pub fn merge(&mut self, other: &Self) -> Result<(), FilmError> {
        self.check_mergeable(other)?;
        let samples = self.facts.samples.union(&other.facts.samples)?;
        self.film.merge(&other.film)?;
        self.facts.samples = samples;
        self.facts.seconds += other.facts.seconds;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
