use super::*;

fn flat(width: u32, height: u32, colour: Colour) -> Canvas {
    Canvas::new(width, height, colour).unwrap()
}

fn changed(canvas: &Canvas, colour: Colour) -> Vec<(u32, u32)> {
    let places = (0..canvas.height()).flat_map(|y| (0..canvas.width()).map(move |x| (x, y)));
    places.filter(|(x, y)| canvas.get(*x, *y) != Some(colour)).collect()
}

#[test]
fn captions_are_bars_along_the_bottom() {
    // A colour that no mean of the bar and the text has.
    let ground = [150, 20, 90];
    for (width, height, bar) in [(400, 300, 24), (800, 600, 30), (1920, 1080, 48)] {
        let mut canvas = flat(width, height, ground);
        caption(&mut canvas, "bdpt", "64 spp");
        let places = changed(&canvas, ground);
        assert_eq!(places.len() as u32, width * bar);
        assert!(places.iter().all(|(_, y)| *y >= height - bar));
        // Text at both ends, none in the middle.
        let bright = |from: u32, to: u32| {
            let inside = |x: u32, y: u32| canvas.get(x, y).is_some_and(|p| p[0] > 200);
            (height - bar..height).any(|y| (from..to).any(|x| inside(x, y)))
        };
        assert!(bright(0, width / 4) && bright(width * 3 / 4, width) && !bright(width / 3, width / 2));
    }
}

#[test]
fn captions_shrink_before_they_are_cut() {
    let words = "bidirectional path tracing with the light image, all strategies";
    let mut roomy = flat(800, 600, [0; 3]);
    caption(&mut roomy, words, "64 spp");
    let mut tight = flat(800, 600, [0; 3]);
    caption(&mut tight, &format!("{words} {words}"), "64 spp · 12.3 s");
    let mut smallest = flat(12, 10, [0; 3]);
    caption(&mut smallest, "left", "right");
    let mut empty = flat(800, 600, [9; 3]);
    caption(&mut empty, "", "");
    let top = |canvas: &Canvas| changed(canvas, [0; 3]).iter().map(|(_, y)| *y).min();
    assert!(top(&roomy) < top(&tight), "the smaller text begins lower");
}

#[test]
fn labels_stand_in_their_corners() {
    for (corner, left) in [(Corner::TopLeft, true), (Corner::TopRight, false)] {
        let mut canvas = flat(800, 600, [90; 3]);
        label(&mut canvas, "light image off", corner);
        let places = changed(&canvas, [90; 3]);
        assert!(!places.is_empty() && places.iter().all(|(x, y)| (*x < 400) == left && *y < 100));
    }
    label(&mut flat(3, 2, [0; 3]), "too long for this", Corner::TopRight);
}

#[test]
fn wipes_show_both_sides() {
    let (a, b) = (flat(800, 600, [200, 0, 0]), flat(800, 600, [0, 0, 200]));
    let joined = wipe(&a, &b, 0.25).unwrap();
    assert_eq!((joined.get(195, 300), joined.get(205, 300)), (Some([200, 0, 0]), Some([0, 0, 200])));
    assert_eq!(joined.get(200, 0), Some(LINE));
    assert!(wipe(&a, &b, 0.0).unwrap() == b && wipe(&a, &b, 7.0).unwrap() == a);
    assert!(wipe(&a, &b, f32::NAN).unwrap() == b);
}

#[test]
fn fades_are_made_in_linear_light() {
    let (black, white) = (flat(4, 2, [0; 3]), flat(4, 2, [255; 3]));
    assert_eq!(cross_fade(&black, &white, 0.5).unwrap().get(0, 0), Some([188; 3]));
    assert!(cross_fade(&black, &white, 0.0).unwrap() == black);
    assert!(cross_fade(&black, &white, 1.0).unwrap() == white);
    assert!(cross_fade(&black, &white, f32::NAN).unwrap() == black);
}

#[test]
fn pairs_stand_side_by_side() {
    let (a, b) = (flat(400, 300, [1; 3]), flat(400, 300, [2; 3]));
    let joined = side_by_side(&a, &b).unwrap();
    assert_eq!((joined.width(), joined.height()), (800, 300));
    let row = [398, 399, 400, 401].map(|x| joined.get(x, 299).unwrap());
    assert_eq!(row, [[1; 3], JOINT, JOINT, [2; 3]]);
    let other = flat(400, 301, [0; 3]);
    for error in [side_by_side(&a, &other), wipe(&a, &other, 0.5), cross_fade(&a, &other, 0.5)] {
        let text = error.unwrap_err().to_string();
        assert!(text.contains("400 × 300 and 400 × 301"), "{text}");
    }
}
