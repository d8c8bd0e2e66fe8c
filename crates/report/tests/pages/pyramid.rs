//! The page of strategies: sums that follow the switches.

use std::fs;

use caustica_math::Rgb;
use caustica_report::{Pyramid, StrategyImages, write_pyramid};

use crate::chrome::{Browser, Device, Page};
use crate::{LAPTOP, PHONE, assert_near, byte, place};

const SIZE: [u32; 2] = [32, 24];

/// What strategy (s, t) adds to a pixel: no two sums are alike.
fn share(s: u32, t: u32, i: u32) -> f32 {
    0.011 * (s + 1) as f32 + 0.007 * (t * t) as f32 + 0.0001 * i as f32
}

fn strategies() -> Vec<[u32; 2]> {
    (1..=3).flat_map(|length| (0..=length).map(move |s| [s, length + 1 - s])).collect()
}

fn sample() -> Pyramid {
    let image = |factor: f32, [s, t]: [u32; 2]| {
        (0..SIZE[0] * SIZE[1]).map(|i| Rgb::new(1.0, 0.5, 0.25) * (factor * share(s, t, i))).collect()
    };
    let strategy = |[s, t]: [u32; 2]| {
        let [weighted, unweighted] = [1.0, 1.5].map(|factor| image(factor, [s, t]));
        StrategyImages { s, t, weighted, unweighted }
    };
    Pyramid {
        title: "Test".into(),
        width: SIZE[0],
        height: SIZE[1],
        strategies: strategies().into_iter().map(strategy).collect(),
        rest: Vec::new(),
        notes: Vec::new(),
    }
}

/// The red of the sum that the page holds at pixel `i` is that of the strategies chosen by `on`, to the
/// precision of halves.
fn check_sum(page: &mut Page, factor: f32, on: impl Fn(u32, u32) -> bool) {
    let chosen = || strategies().into_iter().filter(|&[s, t]| on(s, t));
    for i in [0, 100, SIZE[0] * SIZE[1] - 1] {
        let expected = f64::from(factor * chosen().map(|[s, t]| share(s, t, i)).sum::<f32>());
        let found = page.number(&format!("caustica.viewer.images[0].pixels.data[{}]", 3 * i));
        assert!((found - expected).abs() <= expected / 2048.0, "{found} is not {expected}");
    }
    let expected: f32 = factor * chosen().map(|[s, t]| share(s, t, 100)).sum::<f32>();
    page.key("1");
    let at = place(page, 4.0, 3.0);
    assert_near(page.colour(at), [1.0, 0.5, 0.25].map(|c| byte(c * expected)));
}

fn check_switches(page: &mut Page) {
    check_sum(page, 1.0, |_, _| true);
    page.click("[data-light]");
    check_sum(page, 1.0, |_, t| t != 1);
    page.click("input[aria-label='s = 0, t = 3']");
    check_sum(page, 1.0, |s, t| t != 1 && [s, t] != [0, 3]);
    page.click(".tier:nth-child(3) .tier-name");
    check_sum(page, 1.0, |s, t| (t != 1 && [s, t] != [0, 3]) || s + t == 4);
    page.click("[data-set=unweighted]");
    page.wait("document.querySelector('[data-set=unweighted]').ariaPressed === 'true'");
    check_sum(page, 1.5, |s, t| (t != 1 && [s, t] != [0, 3]) || s + t == 4);
    page.click("[data-all=off]");
    check_sum(page, 1.5, |_, _| false);
    // Exactly nothing is left.
    assert_eq!(page.number("Math.max(...caustica.pyramid.total.map(Math.abs))"), 0.0);
    page.click("[data-set=weighted]");
    page.wait("document.querySelector('[data-set=weighted]').ariaPressed === 'true'");
    page.click("[data-all=on]");
    check_sum(page, 1.0, |_, _| true);
}

fn check_large(page: &mut Page) {
    page.click("[title='Show s = 2, t = 2 large']");
    assert_eq!(page.text("[data-part=tag-left]"), "s = 2, t = 2");
    let at = place(page, 4.0, 3.0);
    let expected = [1.0, 0.5, 0.25].map(|c| byte(c * share(2, 2, 100)));
    assert_near(page.colour(at), expected);
    page.key("e");
    page.key("e");
    assert_near(page.colour(at), [1.0, 0.5, 0.25].map(|c| byte(2.0 * c * share(2, 2, 100))));
    // Thumbnails follow the exposure. Cells are told by their place: (2, 2) is the third of the third tier.
    page.settle();
    let pixel = "[...document.querySelectorAll('.tier:nth-child(3) canvas')[2]
        .getContext('2d').getImageData(4, 3, 1, 1).data]";
    let thumbnail = page.eval(pixel);
    assert_eq!(thumbnail[0], byte(2.0 * share(2, 2, 100)), "{thumbnail}");
    page.eval("caustica.viewer.set({ stops: 0 })");
}

/// However far the tiers are scrolled, the picture is seen.
fn check_sight(page: &mut Page) {
    page.eval("document.querySelector('.tier:last-child').scrollIntoView({ block: 'end' })");
    page.settle();
    let top = page.number("caustica.viewer.parts.stage.getBoundingClientRect().top");
    assert!(top >= 0.0, "{top}");
    page.eval("scrollTo(0, 0)");
}

#[test]
fn switches_change_the_sum() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("pyramid.html");
    write_pyramid(&sample(), &file).unwrap();
    let file = fs::canonicalize(file).unwrap();
    let Some(mut browser) = Browser::start(&[]) else { return };
    for device in [LAPTOP, Device { dark: true, ..LAPTOP }, PHONE, Device { dark: true, ..PHONE }] {
        let mut page = browser.open(&file, device);
        assert_eq!(page.number("document.querySelectorAll('.tier').length"), 3.0);
        check_switches(&mut page);
        check_large(&mut page);
        check_sight(&mut page);
        assert_eq!(page.complaints(), [""; 0], "{device:?}");
    }
    let address = format!("file://{}#image=s+%3D+1%2C+t+%3D+2&stops=1", file.display());
    let mut page = browser.open_address(&address, LAPTOP);
    assert_eq!(page.text("[data-part=tag-left]"), "s = 1, t = 2");
    assert_eq!(page.number("caustica.viewer.state.stops"), 1.0);
}

/// All longer paths are a tile of their own, weighted in both sums.
#[test]
fn longer_paths_are_switched_too() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("pyramid.html");
    let longer = vec![Rgb::new(0.25, 0.0, 0.0); (SIZE[0] * SIZE[1]) as usize];
    write_pyramid(&Pyramid { rest: longer, ..sample() }, &file).unwrap();
    let file = fs::canonicalize(file).unwrap();
    let Some(mut browser) = Browser::start(&[]) else { return };
    let mut page = browser.open(&file, LAPTOP);
    let red = "caustica.viewer.images[0].pixels.data[300]";
    let sum = |factor: f32| {
        f64::from(factor * strategies().into_iter().map(|[s, t]| share(s, t, 100)).sum::<f32>())
    };
    let near =
        |found: f64, expected: f64| assert!((found - expected).abs() < 1e-3 * expected, "{found} {expected}");
    near(page.number(red), sum(1.0) + 0.25);
    page.click("input[aria-label='all longer paths']");
    near(page.number(red), sum(1.0));
    page.click(".tier:last-child .tier-name");
    near(page.number(red), sum(1.0) + 0.25);
    page.click("[data-set=unweighted]");
    page.wait("document.querySelector('[data-set=unweighted]').ariaPressed === 'true'");
    near(page.number(red), sum(1.5) + 0.25);
    page.click("[title='Show all longer paths large']");
    assert_eq!(page.text("[data-part=tag-left]"), "all longer paths");
    assert_eq!(page.complaints(), [""; 0]);
}
