//! Which samples are in a film.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::FilmError;

/// A set of sample numbers, each of which every pixel has had once: ranges in order that neither touch nor overlap.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Vec<Range<u64>>", into = "Vec<Range<u64>>")]
pub struct SampleRanges(Vec<Range<u64>>);

impl SampleRanges {
    /// How many samples.
    pub fn total(&self) -> u64 {
        self.0.iter().map(|r| r.end - r.start).sum()
    }

    /// The ranges.
    pub fn as_slice(&self) -> &[Range<u64>] {
        &self.0
    }

    /// The range, if it is only one; nothing as 0..0.
    pub fn single(&self) -> Option<Range<u64>> {
        match self.0.as_slice() {
            [] => Some(0..0),
            [one] => Some(one.clone()),
            _ => None,
        }
    }

    /// The first samples that both hold.
    pub fn overlap(&self, other: &Self) -> Option<Range<u64>> {
        let pairs = self.0.iter().flat_map(|a| other.0.iter().map(move |b| (a, b)));
        let common = pairs.map(|(a, b)| a.start.max(b.start)..a.end.min(b.end));
        common.filter(|r| !r.is_empty()).min_by_key(|r| r.start)
    }

    /// Whether all of the other samples are among these.
    pub fn contains(&self, other: &Self) -> bool {
        let holds = |r: &Range<u64>| self.0.iter().any(|own| own.start <= r.start && r.end <= own.end);
        other.0.iter().all(holds)
    }

    /// Those of both.
    ///
    /// # Errors
    /// If both hold the same samples.
    pub fn union(&self, other: &Self) -> Result<Self, FilmError> {
        self.0.iter().chain(&other.0).cloned().collect::<Vec<_>>().try_into()
    }
}

impl From<Range<u64>> for SampleRanges {
    fn from(range: Range<u64>) -> Self {
        Self(if range.is_empty() { Vec::new() } else { vec![range] })
    }
}

impl From<SampleRanges> for Vec<Range<u64>> {
    fn from(ranges: SampleRanges) -> Self {
        ranges.0
    }
}

impl TryFrom<Vec<Range<u64>>> for SampleRanges {
    type Error = FilmError;

    /// Ranges in any order; those that touch become one, empty ones go.
    fn try_from(mut ranges: Vec<Range<u64>>) -> Result<Self, FilmError> {
        ranges.retain(|r| !r.is_empty());
        ranges.sort_by_key(|r| r.start);
        let mut joined: Vec<Range<u64>> = Vec::new();
        for range in ranges {
            match joined.last_mut() {
                Some(last) if last.end > range.start => {
                    let twice = range.start..range.end.min(last.end);
                    return Err(FilmError::Merge(format!("the samples {} are there twice", Shown(&twice))));
                }
                Some(last) if last.end == range.start => last.end = range.end,
                _ => joined.push(range),
            }
        }
        Ok(Self(joined))
    }
}

impl fmt::Display for SampleRanges {
    /// Such as `0..100, 200..300`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, range) in self.0.iter().enumerate() {
            write!(f, "{}{}", if i > 0 { ", " } else { "" }, Shown(range))?;
        }
        Ok(())
    }
}

/// A range in the way that it is asked for.
struct Shown<'a>(&'a Range<u64>);

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.0.start, self.0.end)
    }
}

impl FromStr for SampleRanges {
    type Err = FilmError;

    /// One range, such as `1000..2000`: the second number is not in it.
    fn from_str(text: &str) -> Result<Self, FilmError> {
        let parsed = text
            .split_once("..")
            .and_then(|(a, b)| Some(a.trim().parse::<u64>().ok()?..b.trim().parse::<u64>().ok()?));
        match parsed {
            Some(range) if !range.is_empty() => Ok(range.into()),
            _ => {
                Err(FilmError::unknown("range of samples", text, "one such as 1000..2000, the end not in it"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranges(text: &str) -> SampleRanges {
        let all: Vec<Range<u64>> = text
            .split(", ")
            .filter(|t| !t.is_empty())
            .map(|t| t.parse::<SampleRanges>().unwrap().0[0].clone())
            .collect();
        all.try_into().unwrap()
    }

    #[test]
    fn ranges_are_read_and_shown() {
        assert_eq!("1000..2000".parse::<SampleRanges>().unwrap().to_string(), "1000..2000");
        for wrong in ["", "5", "5..5", "7..5", "-1..5", "..5", "1...5", "a..b", "1..99999999999999999999"] {
            let error = wrong.parse::<SampleRanges>().unwrap_err().to_string();
            assert!(error.contains("such as 1000..2000"), "{error}");
        }
    }

    #[test]
    fn unions_join_what_touches_in_any_order() {
        let (a, b, c) = (ranges("0..10"), ranges("10..15, 20..30"), ranges("15..20"));
        let all = a.union(&b).unwrap().union(&c).unwrap();
        assert_eq!(all.to_string(), "0..30");
        assert_eq!(c.union(&a).unwrap().union(&b).unwrap(), all);
        assert_eq!((all.total(), all.single()), (30, Some(0..30)));
        assert_eq!((b.total(), b.single()), (15, None));
        let none = SampleRanges::default();
        assert_eq!((none.total(), none.single(), none.to_string().as_str()), (0, Some(0..0), ""));
        assert_eq!(a.union(&none).unwrap(), a);
    }

    #[test]
    fn what_both_have_is_found() {
        let (a, b) = (ranges("0..10, 20..30"), ranges("10..12, 25..40"));
        assert_eq!(a.overlap(&b), Some(25..30));
        assert_eq!(a.overlap(&ranges("10..20")), None);
        let error = a.union(&b).unwrap_err().to_string();
        assert!(error.contains("the samples 25..30 are there twice"), "{error}");
        let inside = ranges("22..23");
        assert_eq!(a.overlap(&inside), Some(22..23));
        assert!(a.union(&inside).unwrap_err().to_string().contains("22..23"));
    }
}
