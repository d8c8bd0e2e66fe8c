//! Text with smooth edges, in Noto Sans Mono.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, RasterizedChar, get_raster, get_raster_width};

use crate::draw::blend;
use crate::{Canvas, Colour};

/// The height of a line of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TextSize {
    /// 16 pixels, each character 7 wide.
    Small,
    /// 20 pixels, each character 9 wide.
    Medium,
    /// 24 pixels, each character 11 wide.
    Large,
    /// 32 pixels, each character 14 wide.
    Huge,
}

impl TextSize {
    /// All sizes, smallest first.
    pub const ALL: [Self; 4] = [Self::Small, Self::Medium, Self::Large, Self::Huge];

    /// The height of a line in pixels.
    pub fn height(self) -> u32 {
        self.raster().val() as u32
    }

    /// The width of one character in pixels.
    pub fn advance(self) -> u32 {
        get_raster_width(FontWeight::Regular, self.raster()) as u32
    }

    /// The width in pixels of a line of text as it is drawn.
    pub fn width_of(self, text: &str) -> u32 {
        let count = glyphs(text).count().try_into().unwrap_or(u32::MAX);
        self.advance().saturating_mul(count)
    }

    /// The size that suits labels on a picture of this height in pixels.
    pub fn for_height(height: u32) -> Self {
        match height {
            0..360 => Self::Small,
            360..660 => Self::Medium,
            660..1000 => Self::Large,
            _ => Self::Huge,
        }
    }

    fn raster(self) -> RasterHeight {
        match self {
            Self::Small => RasterHeight::Size16,
            Self::Medium => RasterHeight::Size20,
            Self::Large => RasterHeight::Size24,
            Self::Huge => RasterHeight::Size32,
        }
    }
}

/// How heavy the strokes are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weight {
    /// For running text.
    #[default]
    Regular,
    /// For titles.
    Bold,
}

/// How text is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextStyle {
    /// The height of the line.
    pub size: TextSize,
    /// The strokes.
    pub weight: Weight,
    /// The colour of the strokes.
    pub colour: Colour,
}

impl TextStyle {
    /// Regular text.
    pub const fn new(size: TextSize, colour: Colour) -> Self {
        Self { size, weight: Weight::Regular, colour }
    }

    /// Bold text.
    pub const fn bold(size: TextSize, colour: Colour) -> Self {
        Self { size, weight: Weight::Bold, colour }
    }
}

impl Canvas {
    /// Draws one line of text whose top left corner is at (`x`, `y`). The font has Latin-1; some signs
    /// are put together from others (≥, ≤, ≠), dashes, quotes and arrows become their plain
    /// forms, line breaks become spaces, and what is left becomes the replacement character �.
    pub fn text(&mut self, x: i32, y: i32, text: &str, style: TextStyle) {
        let mut left = i64::from(x);
        for glyph in glyphs(text) {
            if left >= i64::from(self.width()) {
                break;
            }
            for part in [Some(glyph.base), glyph.over].into_iter().flatten() {
                self.glyph(left, i64::from(y), raster(part, style), style.colour);
            }
            left += i64::from(style.size.advance());
        }
    }

    fn glyph(&mut self, x: i64, y: i64, raster: RasterizedChar, colour: Colour) {
        for (row, covers) in (y..).zip(raster.rows()) {
            if !(0..i64::from(self.height())).contains(&row) {
                continue;
            }
            let width = i64::from(self.width());
            let pixels = self.row_mut(row as usize);
            for (column, cover) in (x..).zip(covers) {
                if (0..width).contains(&column) {
                    let pixel = &mut pixels[column as usize];
                    *pixel = blend(*pixel, colour, *cover);
                }
            }
        }
    }
}

fn raster(character: char, style: TextStyle) -> RasterizedChar {
    let weight = match style.weight {
        Weight::Regular => FontWeight::Regular,
        Weight::Bold => FontWeight::Bold,
    };
    let get = |c| get_raster(c, weight, style.size.raster());
    get(character)
        .or_else(|| get(char::REPLACEMENT_CHARACTER))
        .expect("the font has its replacement character")
}

/// One place in a line: a character, and perhaps a second one drawn over it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Glyph {
    base: char,
    over: Option<char>,
}

fn glyphs(text: &str) -> impl Iterator<Item = Glyph> {
    text.chars().flat_map(|character| {
        let (plain, over) = match character {
            '≥' => (">", Some('_')),
            '≤' => ("<", Some('_')),
            '≠' => ("=", Some('/')),
            '–' | '—' | '−' | '‐' | '‑' => ("-", None),
            '…' => ("...", None),
            '‘' | '’' | '′' => ("'", None),
            '“' | '”' | '″' => ("\"", None),
            '→' => ("->", None),
            '←' => ("<-", None),
            '≈' => ("~", None),
            'μ' => ("µ", None),
            '•' => ("·", None),
            c if c.is_whitespace() => (" ", None),
            _ => ("", None),
        };
        let kept = plain.is_empty().then_some(character);
        plain.chars().chain(kept).map(move |base| Glyph { base, over })
    })
}

/// The text, or its beginning and "..." where it would be wider than `width` pixels.
pub fn shortened(text: &str, size: TextSize, width: u32) -> String {
    if size.width_of(text) <= width {
        return text.to_owned();
    }
    let mut short = text.to_owned();
    while short.pop().is_some() {
        let candidate = format!("{}...", short.trim_end());
        if size.width_of(&candidate) <= width {
            return candidate;
        }
    }
    String::new()
}

/// The text in lines of at most `width` pixels, broken at spaces; a longer word is shortened.
pub fn wrapped(text: &str, size: TextSize, width: u32) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.last_mut().expect("there is a first line");
        let longer = if last.is_empty() { word.to_owned() } else { format!("{last} {word}") };
        if last.is_empty() || size.width_of(&longer) <= width {
            *last = longer;
        } else {
            lines.push(word.to_owned());
        }
    }
    lines.into_iter().map(|line| shortened(&line, size, width)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Colour = [255; 3];

    fn drawn(text: &str, style: TextStyle) -> Canvas {
        let size = style.size;
        let mut canvas = Canvas::new(size.width_of(text).max(1) + 40, size.height() + 8, [0; 3]).unwrap();
        canvas.text(4, 4, text, style);
        canvas
    }

    fn ink(canvas: &Canvas) -> u64 {
        canvas.pixels().iter().map(|p| u64::from(p[1])).sum()
    }

    #[test]
    fn measured_text_stays_within_its_width() {
        for size in TextSize::ALL {
            let text = "bdpt · 1024 spp × 3 ≥ 2…";
            let canvas = drawn(text, TextStyle::bold(size, WHITE));
            let right = 4 + size.width_of(text);
            for y in 0..canvas.height() {
                for x in (0..4).chain(right..canvas.width()) {
                    assert_eq!(canvas.get(x, y), Some([0; 3]), "{size:?}: {x}, {y}");
                }
            }
            assert!(ink(&canvas) > 0);
        }
    }

    #[test]
    fn edges_are_smooth_and_bold_is_heavier() {
        for size in TextSize::ALL {
            let regular = drawn("samples", TextStyle::new(size, WHITE));
            assert!(regular.pixels().iter().any(|p| (30..220).contains(&p[0])));
            assert!(ink(&drawn("samples", TextStyle::bold(size, WHITE))) > ink(&regular));
        }
    }

    #[test]
    fn missing_signs_are_replaced() {
        let style = TextStyle::new(TextSize::Large, WHITE);
        let same = |a: &str, b: &str| drawn(a, style) == drawn(b, style);
        assert!(same("a – b…\n", "a - b... ") && same("μ", "µ") && same("→", "->"));
        assert!(same("漢", "�") && !same("漢", " ") && !same("×", "�") && !same("²", "�"));
        assert!(ink(&drawn("≥", style)) > ink(&drawn(">", style)) && !same("≥", "≤"));
        assert!(TextSize::Small.width_of("…") == 21 && TextSize::Small.width_of("≥") == 7);
    }

    #[test]
    fn text_is_clipped() {
        let mut canvas = Canvas::new(30, 10, [0; 3]).unwrap();
        for (x, y) in [(-9, -3), (25, 4), (i32::MIN, i32::MIN), (i32::MAX, i32::MAX), (3, -100)] {
            canvas.text(x, y, "clipped", TextStyle::new(TextSize::Huge, WHITE));
        }
        assert!(ink(&canvas) > 0);
    }

    #[test]
    fn long_lines_are_shortened_or_wrapped() {
        assert_eq!(shortened("abcdef", TextSize::Small, 42), "abcdef");
        assert_eq!(shortened("abcdef", TextSize::Small, 41), "ab...");
        assert_eq!(shortened("ab cdef", TextSize::Small, 48), "ab...");
        assert_eq!(shortened("abcdef", TextSize::Small, 20), "");
        let lines = wrapped("one two  three incomprehensible", TextSize::Small, 49);
        assert_eq!(lines, ["one two", "three", "inco..."]);
        assert_eq!(wrapped("", TextSize::Small, 50), [""]);
    }
}
