use super::*;

const RED: Colour = [200, 30, 40];
const GREEN: Colour = [20, 180, 60];

fn cell(width: u32, height: u32, colour: Colour) -> Option<Cell> {
    Some(Cell::new(Canvas::new(width, height, colour).unwrap(), "s = 1, t = 2"))
}

/// The first and last column and row in which a colour is.
fn bounds(canvas: &Canvas, colour: Colour) -> [u32; 4] {
    let mut bounds = [u32::MAX, 0, u32::MAX, 0];
    for y in 0..canvas.height() {
        for x in (0..canvas.width()).filter(|x| canvas.get(*x, y) == Some(colour)) {
            bounds = [bounds[0].min(x), bounds[1].max(x), bounds[2].min(y), bounds[3].max(y)];
        }
    }
    bounds
}

#[test]
fn margins_are_even_and_rows_are_centred() {
    let rows = [
        Row { label: String::new(), cells: vec![cell(200, 100, RED)] },
        Row { label: String::new(), cells: vec![cell(200, 100, GREEN), cell(200, 100, GREEN)] },
    ];
    let style = SheetStyle { centred: true, ..SheetStyle::default() };
    let canvas = sheet(&rows, &style).unwrap();
    assert_eq!((canvas.width(), canvas.height()), (24 * 2 + 416, 24 * 2 + 2 * (100 + 6 + 16) + 16));
    assert_eq!(bounds(&canvas, GREEN), [24, canvas.width() - 25, 24 + 138, 24 + 237]);
    assert_eq!(bounds(&canvas, RED), [24 + 108, 24 + 307, 24, 123]);
    let left = sheet(&rows, &SheetStyle::default()).unwrap();
    assert_eq!(bounds(&left, RED)[..2], [24, 223]);
}

#[test]
fn grids_leave_places_free_and_centre_small_pictures() {
    let cells = [None, cell(200, 100, RED), cell(100, 50, GREEN)];
    let canvas = grid(&cells, 2, &SheetStyle::default()).unwrap();
    assert_eq!(bounds(&canvas, RED), [240, 439, 24, 123]);
    assert_eq!(bounds(&canvas, GREEN), [24 + 50, 24 + 149, 24 + 138 + 25, 24 + 138 + 74]);
    assert_eq!(grid(&cells, 0, &SheetStyle::default()).unwrap().height(), 24 * 2 + 3 * 122 + 2 * 16);
}

#[test]
fn outlines_are_around_pictures() {
    let framed = [cell(100, 80, RED).map(|c| c.outlined(GREEN))];
    let canvas = grid(&framed, 1, &SheetStyle::default()).unwrap();
    let ([left, right, top, bottom], frame) = (bounds(&canvas, RED), bounds(&canvas, GREEN));
    assert_eq!(frame, [left - 2, right + 2, top - 2, bottom + 2]);
    assert_eq!((right - left, bottom - top), (99, 79));
}

#[test]
fn titles_labels_and_legends_take_their_room() {
    let row = |label: &str| Row { label: label.to_owned(), cells: vec![cell(400, 100, RED)] };
    let plain = sheet(&[row("")], &SheetStyle::default()).unwrap();
    let style = SheetStyle {
        title: Some("A title that is a good deal too long for one line".to_owned()),
        legend: vec![LegendLine { colour: Some(GREEN), text: "what green means".to_owned() }],
        ..SheetStyle::default()
    };
    let full = sheet(&[row("3 edges")], &style).unwrap();
    assert_eq!(full.width(), plain.width() + 7 * 9 + 16);
    assert_eq!(full.height(), plain.height() + 2 * 24 + 16 + 20 + 16);
    assert!(bounds(&full, GREEN)[2] > bounds(&full, RED)[3]);
    let text = |c: &Canvas| c.pixels().iter().filter(|p| **p == style.foreground).count();
    assert!(text(&full) > text(&plain));
}

#[test]
fn impossible_sheets_are_errors() {
    let style = SheetStyle::default();
    assert!(matches!(sheet(&[], &style), Err(CanvasError::Empty)));
    assert!(matches!(grid(&[None, None], 2, &style), Err(CanvasError::Empty)));
    let vast = SheetStyle { gap: u32::MAX, margin: u32::MAX, ..style };
    assert!(matches!(grid(&[cell(9, 9, RED)], 1, &vast), Err(CanvasError::Size { .. })));
}
