//! Strategies and sets of them.

use std::fmt;
use std::str::FromStr;

/// A way to make a path: `s` vertices from the light walk joined with `t` from the camera walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Strategy {
    /// Light vertices, the point on the lamp included.
    pub s: u32,
    /// Camera vertices, the point on the lens included.
    pub t: u32,
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({}, {})", self.s, self.t)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Comparison {
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Condition {
    of_light: bool,
    comparison: Comparison,
    bound: u32,
}

impl Condition {
    fn holds(self, strategy: Strategy) -> bool {
        let n = if self.of_light { strategy.s } else { strategy.t };
        match self.comparison {
            Comparison::Equal => n == self.bound,
            Comparison::NotEqual => n != self.bound,
            Comparison::Less => n < self.bound,
            Comparison::LessOrEqual => n <= self.bound,
            Comparison::Greater => n > self.bound,
            Comparison::GreaterOrEqual => n >= self.bound,
        }
    }
}

/// Which strategies are used. The weights are those of the set, so that what it can reach stays unbiased.
///
/// Written as alternatives separated by `;`, each a pair like `2,3` (s, t) or conditions like `s=0`, `t>=2`,
/// `s>1&t!=1` joined by `&`; or `all`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StrategySet {
    text: String,
    /// Any of these, each all of its conditions.
    alternatives: Vec<Vec<Condition>>,
    /// The set by classes, if it is a union of them.
    classes: Option<Classes>,
    /// The classes of which it holds any.
    touched: Classes,
}

/// Strategies by class. A path has at most one strategy of each class but `inner`, so that running sums
/// can leave out any class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Classes {
    /// s = 0: the eye path hits the lamp.
    pub hit: bool,
    /// s = 1, t ≥ 2: next-event estimation.
    pub next_event: bool,
    /// t = 1: the light image.
    pub splat: bool,
    /// s ≥ 2, t ≥ 2.
    pub inner: bool,
}

impl Classes {
    fn contains(self, Strategy { s, t }: Strategy) -> bool {
        match (s, t) {
            (0, _) => self.hit,
            (_, 1) => self.splat,
            (1, _) => self.next_event,
            _ => self.inner,
        }
    }
}

impl Default for StrategySet {
    /// All strategies.
    fn default() -> Self {
        Self::from_parts("all".into(), vec![vec![]])
    }
}

impl StrategySet {
    fn from_parts(text: String, alternatives: Vec<Vec<Condition>>) -> Self {
        let mut set = Self { text, alternatives, classes: None, touched: Classes::default() };
        let has = |s, t| set.matches(Strategy { s, t });
        let classes = Classes { hit: has(0, 2), next_event: has(1, 2), splat: has(2, 1), inner: has(2, 2) };
        // Beyond the largest bound no condition changes.
        let reach = set.alternatives.iter().flatten().map(|c| c.bound).max().unwrap_or(0) + 3;
        let reach = reach.min(MAX_BOUND + 3);
        let same = (0..reach).all(|s| {
            (1..reach).all(|t| {
                let strategy = Strategy { s, t };
                (s == 0 && t == 1) || set.matches(strategy) == classes.contains(strategy)
            })
        });
        set.classes = same.then_some(classes);
        let any = |mut s: std::ops::Range<u32>, t: std::ops::Range<u32>| {
            s.any(|s| t.clone().any(|t| set.matches(Strategy { s, t })))
        };
        set.touched = Classes {
            hit: any(0..1, 2..reach),
            next_event: any(1..2, 2..reach),
            splat: any(1..reach, 1..2),
            inner: any(2..reach, 2..reach),
        };
        set
    }

    /// The set without t = 1, for cameras that light paths cannot be joined with.
    #[must_use]
    pub fn without_splats(&self) -> Self {
        let eye = Condition { of_light: false, comparison: Comparison::GreaterOrEqual, bound: 2 };
        let alternatives = self.alternatives.iter().map(|all| {
            let mut all = all.clone();
            all.push(eye);
            all
        });
        let text = if self.is_all() { "t>=2".into() } else { self.text.clone() };
        Self::from_parts(text, alternatives.collect())
    }

    fn matches(&self, strategy: Strategy) -> bool {
        self.alternatives.iter().any(|all| all.iter().all(|c| c.holds(strategy)))
    }

    /// Whether the set holds that strategy.
    #[inline]
    pub fn contains(&self, strategy: Strategy) -> bool {
        match self.classes {
            Some(classes) => classes.contains(strategy),
            None => self.matches(strategy),
        }
    }

    /// The set as a union of classes, if it is one. Weights by running sums need that.
    #[inline]
    pub fn classes(&self) -> Option<Classes> {
        self.classes
    }

    /// The classes of which the set holds any strategy.
    #[inline]
    pub fn touched(&self) -> Classes {
        self.touched
    }

    /// Whether it holds every strategy.
    pub fn is_all(&self) -> bool {
        self.classes == Some(Classes { hit: true, next_event: true, splat: true, inner: true })
    }
}

impl fmt::Display for StrategySet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Larger bounds mean a typing error.
const MAX_BOUND: u32 = 1000;

/// Why a set could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseStrategyError(String);

impl fmt::Display for ParseStrategyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "`{}` is no set of strategies; examples: `s=0`, `t>=2`, `2,3`, `s>=2&t>=2`, `s=0;s=1`, `all`",
            self.0
        )
    }
}

impl std::error::Error for ParseStrategyError {}

impl FromStr for StrategySet {
    type Err = ParseStrategyError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let compact: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        let error = || ParseStrategyError(text.to_owned());
        if compact == "all" {
            return Ok(Self::default());
        }
        let alternatives = compact
            .split(';')
            .map(|a| parse_alternative(a).ok_or_else(error))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Self::from_parts(text.trim().to_owned(), alternatives))
    }
}

fn parse_alternative(text: &str) -> Option<Vec<Condition>> {
    if let Some((s, t)) = text.split_once(',') {
        let equal = |of_light, n: &str| {
            Some(Condition { of_light, comparison: Comparison::Equal, bound: parse_bound(n)? })
        };
        return Some(vec![equal(true, s)?, equal(false, t)?]);
    }
    text.split('&').map(parse_condition).collect()
}

fn parse_condition(text: &str) -> Option<Condition> {
    let (of_light, rest) = match text.strip_prefix('s') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('t')?),
    };
    let operators = [
        (">=", Comparison::GreaterOrEqual),
        ("<=", Comparison::LessOrEqual),
        ("!=", Comparison::NotEqual),
        ("=", Comparison::Equal),
        ("<", Comparison::Less),
        (">", Comparison::Greater),
    ];
    let (comparison, number) = operators.iter().find_map(|(o, c)| Some((*c, rest.strip_prefix(o)?)))?;
    Some(Condition { of_light, comparison, bound: parse_bound(number)? })
}

fn parse_bound(text: &str) -> Option<u32> {
    text.parse().ok().filter(|n| *n <= MAX_BOUND)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(text: &str) -> StrategySet {
        text.parse().unwrap()
    }

    #[test]
    fn sets_hold_what_they_say() {
        let has = |text: &str, s, t| set(text).contains(Strategy { s, t });
        assert!(has("all", 5, 7) && set("all").is_all());
        assert!(has("s=0", 0, 9) && !has("s=0", 1, 2));
        assert!(has("t>=2", 0, 2) && !has("t>=2", 2, 1));
        assert!(has("2,3", 2, 3) && !has("2,3", 3, 2) && !has("2,3", 2, 4));
        assert!(has("s=0; s = 1", 1, 4) && has("s=0;s=1", 0, 4) && !has("s=0;s=1", 2, 4));
        assert!(has("s>=2&t!=3", 2, 2) && !has("s>=2&t!=3", 2, 3));
    }

    #[test]
    fn unions_of_classes_are_recognised() {
        for text in ["all", "s=0", "t>=2", "t=1&s>=1", "s=0;s=1&t>1", "s>=2&t>=2"] {
            assert!(set(text).classes().is_some(), "{text}");
        }
        for text in ["2,3", "s<3", "s=1", "t>=3", "s=4"] {
            assert!(set(text).classes().is_none(), "{text}");
        }
    }

    #[test]
    fn splats_can_be_left_out() {
        assert_eq!(set("all").without_splats(), set("t>=2"));
        for text in ["s=0;s=1", "t=1", "2,3;4,1"] {
            let (with, without) = (set(text), set(text).without_splats());
            // Every path has two vertices at least.
            let all = (0..6).flat_map(|s| (1..6).map(move |t| Strategy { s, t }));
            for strategy in all.filter(|strategy| strategy.s + strategy.t > 1) {
                let expected = with.contains(strategy) && strategy.t != 1;
                assert_eq!(without.contains(strategy), expected, "{text}: {strategy}");
            }
        }
        assert!(!set("t=1").without_splats().touched().splat);
    }

    #[test]
    fn nonsense_is_refused() {
        for text in ["", "s", "x=1", "s=", "s=-1", "1,2,3", "s==1", "s=0;", "t>=99999999999"] {
            assert!(text.parse::<StrategySet>().is_err(), "{text}");
        }
    }
}
