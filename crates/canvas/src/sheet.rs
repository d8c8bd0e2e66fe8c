//! Sheets: many pictures with captions, in rows.

use crate::{Area, Canvas, CanvasError, Colour, TextSize, TextStyle, shortened, wrapped};

/// The line around a picture that has no outline of its own, so that black pictures have edges too.
const FAINT: Colour = [62, 62, 62];
const OUTLINE: u32 = 2;
const CAPTION_GAP: u32 = 6;
/// Titles and legends are not squeezed into less, in pixels.
const LEAST_WIDTH: u32 = 320;

/// A picture on a sheet.
#[derive(Clone, Debug)]
pub struct Cell {
    /// What is shown, pixel by pixel.
    pub picture: Canvas,
    /// One line beneath it; shortened where it is wider than the sheet's widest picture.
    pub caption: String,
    /// The colour of a frame around it.
    pub outline: Option<Colour>,
}

impl Cell {
    /// A picture with a caption and no outline.
    pub fn new(picture: Canvas, caption: impl Into<String>) -> Self {
        Self { picture, caption: caption.into(), outline: None }
    }

    /// The same with a frame around the picture.
    pub fn outlined(self, colour: Colour) -> Self {
        Self { outline: Some(colour), ..self }
    }
}

/// A row of a sheet; `None` leaves a place free.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// What stands at its left; empty for nothing.
    pub label: String,
    /// Its places from the left.
    pub cells: Vec<Option<Cell>>,
}

/// A line of the legend.
#[derive(Clone, Debug)]
pub struct LegendLine {
    /// The colour of the square before it, if it explains an outline.
    pub colour: Option<Colour>,
    /// Its words, broken into more lines where there are too many.
    pub text: String,
}

/// How a sheet looks.
#[derive(Clone, Debug)]
pub struct SheetStyle {
    /// The heading.
    pub title: Option<String>,
    /// What stands beneath the pictures.
    pub legend: Vec<LegendLine>,
    /// Whether each row stands in the middle, as in a pyramid, or begins at the left.
    pub centred: bool,
    /// Pixels around everything.
    pub margin: u32,
    /// Pixels between pictures.
    pub gap: u32,
    /// What is beneath everything.
    pub background: Colour,
    /// Titles and captions; labels and legends are a little nearer to the background.
    pub foreground: Colour,
    /// The size of captions; otherwise it follows the width of the pictures.
    pub caption_size: Option<TextSize>,
}

impl Default for SheetStyle {
    fn default() -> Self {
        Self {
            title: None,
            legend: Vec::new(),
            centred: false,
            margin: 24,
            gap: 16,
            background: [27, 27, 27],
            foreground: [226, 226, 226],
            caption_size: None,
        }
    }
}

/// Lays cells out in rows of `columns` (at least one); the last row may be shorter.
pub fn grid(cells: &[Option<Cell>], columns: usize, style: &SheetStyle) -> Result<Canvas, CanvasError> {
    let row = |cells: &[Option<Cell>]| Row { label: String::new(), cells: cells.to_vec() };
    sheet(&cells.chunks(columns.max(1)).map(row).collect::<Vec<_>>(), style)
}

/// Lays rows of pictures out on one canvas: the title, the rows with their labels, the legend. All places
/// are as large as the largest picture. An error if there is no picture or the sheet would be too large.
pub fn sheet(rows: &[Row], style: &SheetStyle) -> Result<Canvas, CanvasError> {
    let plan = Plan::new(rows, style)?;
    let mut canvas = Canvas::new(plan.width, plan.height, style.background)?;
    let mut y = style.margin;
    for line in &plan.title {
        canvas.text(style.margin as i32, y as i32, line, plan.title_style(style));
        y += plan.title_size.height();
    }
    if !plan.title.is_empty() {
        y += style.gap;
    }
    for row in rows {
        plan.draw_row(&mut canvas, row, y, style);
        y += plan.slot_height + style.gap;
    }
    for line in &plan.legend {
        let (x, side) = (style.margin as i32, plan.small.advance() + 3);
        let middle = y + (plan.small.height() - side) / 2;
        if let Some(colour) = line.colour {
            canvas.fill(Area::new(x, middle as i32, side, side), colour, 1.0);
        }
        let indent = plan.legend_indent as i32;
        canvas.text(x + indent, y as i32, &line.text, TextStyle::new(plan.small, muted(style)));
        y += plan.small.height();
    }
    Ok(canvas)
}

fn muted(style: &SheetStyle) -> Colour {
    crate::draw::blend(style.background, style.foreground, 185)
}

/// The sizes and broken lines of a sheet.
struct Plan {
    /// Of the largest picture.
    cell: (u32, u32),
    /// Of a picture with its caption.
    slot_height: u32,
    columns: u32,
    /// Of the rows' labels with the gap after them.
    label_width: u32,
    /// Of labels, captions and legend.
    small: TextSize,
    title_size: TextSize,
    title: Vec<String>,
    legend: Vec<LegendLine>,
    legend_indent: u32,
    width: u32,
    height: u32,
}

impl Plan {
    fn new(rows: &[Row], style: &SheetStyle) -> Result<Self, CanvasError> {
        let cells = || rows.iter().flat_map(|row| row.cells.iter().flatten());
        let widest = cells().map(|c| c.picture.width()).max().ok_or(CanvasError::Empty)?;
        let tallest = cells().map(|c| c.picture.height()).max().ok_or(CanvasError::Empty)?;
        let columns = rows.iter().map(|row| row.cells.len()).max().unwrap_or(0) as u64;
        let small = style.caption_size.unwrap_or_else(|| caption_size(widest));
        let labels = rows.iter().map(|row| small.width_of(&row.label)).max().unwrap_or(0);
        let label_width = if labels > 0 { labels.saturating_add(style.gap) } else { 0 };
        let captioned = cells().any(|c| !c.caption.is_empty());
        let caption = if captioned { CAPTION_GAP + small.height() } else { 0 };
        let (margin, gap) = (u64::from(style.margin), u64::from(style.gap));

        let content = u64::from(label_width) + columns * (u64::from(widest) + gap) - gap;
        let content = content.max(LEAST_WIDTH.into());
        let slot_height = u64::from(tallest) + u64::from(caption);
        let body = rows.len() as u64 * (slot_height + gap) - gap;
        // Before lines are broken, so that sizes beyond all bounds end here.
        Canvas::check_size(content + 2 * margin, body + 2 * margin)?;
        let title_size = if content < 640 { TextSize::Large } else { TextSize::Huge };
        let title =
            style.title.iter().flat_map(|t| wrapped(t, title_size, content as u32)).collect::<Vec<_>>();
        let (legend, legend_indent) = broken_legend(style, small, content as u32);

        let lines = |count: usize, size: TextSize| match count as u64 {
            0 => 0,
            count => count * u64::from(size.height()) + gap,
        };
        let (width, height) = (
            content + 2 * margin,
            body + 2 * margin + lines(title.len(), title_size) + lines(legend.len(), small),
        );
        Canvas::check_size(width, height)?;
        let (cell, slot_height, columns) = ((widest, tallest), slot_height as u32, columns as u32);
        let (width, height) = (width as u32, height as u32);
        Ok(Self {
            cell,
            slot_height,
            columns,
            label_width,
            small,
            title_size,
            title,
            legend,
            legend_indent,
            width,
            height,
        })
    }

    fn title_style(&self, style: &SheetStyle) -> TextStyle {
        TextStyle::bold(self.title_size, style.foreground)
    }

    fn draw_row(&self, canvas: &mut Canvas, row: &Row, y: u32, style: &SheetStyle) {
        let (width, height) = self.cell;
        let step = width + style.gap;
        let body = self.columns * step - style.gap;
        let own = (row.cells.len() as u32 * step).saturating_sub(style.gap);
        let content = self.width - 2 * style.margin - self.label_width;
        let indent = if style.centred { (content - own) / 2 } else { (content - body) / 2 };
        let middle = y + height.saturating_sub(self.small.height()) / 2;
        let label = TextStyle::new(self.small, muted(style));
        canvas.text(style.margin as i32, middle as i32, &row.label, label);
        let left = style.margin + self.label_width + indent;
        for (x, cell) in (left..).step_by(step as usize).zip(&row.cells) {
            if let Some(cell) = cell {
                self.draw_cell(canvas, cell, (x, y), style);
            }
        }
    }

    fn draw_cell(&self, canvas: &mut Canvas, cell: &Cell, (x, y): (u32, u32), style: &SheetStyle) {
        let (width, height) = self.cell;
        let picture = &cell.picture;
        let left = (x + (width - picture.width()) / 2) as i32;
        let top = (y + (height - picture.height()) / 2) as i32;
        let area = Area::new(left, top, picture.width(), picture.height());
        match cell.outline {
            Some(colour) => canvas.outline(area, colour, OUTLINE),
            None => canvas.outline(area, FAINT, 1),
        }
        canvas.blit(picture, left, top);
        let caption = shortened(&cell.caption, self.small, width);
        let indent = (width - self.small.width_of(&caption)) / 2;
        let (x, y) = ((x + indent) as i32, (y + height + CAPTION_GAP) as i32);
        canvas.text(x, y, &caption, TextStyle::new(self.small, style.foreground));
    }
}

fn caption_size(width: u32) -> TextSize {
    match width {
        0..300 => TextSize::Small,
        300..700 => TextSize::Medium,
        _ => TextSize::Large,
    }
}

/// The legend's lines of at most `width` pixels, and where their words begin.
fn broken_legend(style: &SheetStyle, size: TextSize, width: u32) -> (Vec<LegendLine>, u32) {
    let coloured = style.legend.iter().any(|line| line.colour.is_some());
    let indent = if coloured { 3 * size.advance() } else { 0 };
    let mut lines = Vec::new();
    for line in &style.legend {
        let pieces = wrapped(&line.text, size, width.saturating_sub(indent));
        let colours = std::iter::once(line.colour).chain(std::iter::repeat(None));
        lines.extend(pieces.into_iter().zip(colours).map(|(text, colour)| LegendLine { colour, text }));
    }
    (lines, indent)
}

#[cfg(test)]
#[path = "sheet/tests.rs"]
mod tests;
