//! The sample pages on a laptop and a phone, light and dark.

use std::fs;
use std::path::PathBuf;

use caustica_report::{Comparison, Entry, Pyramid, comparison_page, pyramid_page};
use serde_json::json;

use crate::chrome::{Browser, Device, Page};
use crate::{LAPTOP, PHONE, sample};

/// Where pictures are kept, if anyone wants them.
fn album() -> Option<PathBuf> {
    std::env::var_os("CAUSTICA_SCREENSHOTS").map(PathBuf::from)
}

fn keep(page: &mut Page, name: &str) {
    let Some(folder) = album() else { return };
    fs::create_dir_all(&folder).unwrap();
    for (kind, how) in [("window", json!({})), ("whole", json!({ "captureBeyondViewport": true }))] {
        let mut how = how;
        if kind == "whole" {
            let size = page.call("Page.getLayoutMetrics", json!({}))["cssContentSize"].clone();
            how["clip"] =
                json!({ "x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1 });
        }
        let file = folder.join(format!("{name}-{kind}.png"));
        fs::write(&file, page.screenshot(how)).unwrap();
        println!("{}", file.display());
    }
}

/// Nothing may be wider than the window, and text must stand out from its ground.
fn check(page: &mut Page, device: Device) {
    let wide = page.number("document.documentElement.scrollWidth") - f64::from(device.width);
    assert!(wide <= 0.0, "{device:?}: the page is {wide} pixels too wide");
    let light = |property: &str| {
        format!(
            "(([r, g, b]) => r + g + b)(getComputedStyle(document.body).{property}.match(/[0-9.]+/g).map(Number))"
        )
    };
    let (paper, ink) = (page.number(&light("backgroundColor")), page.number(&light("color")));
    assert_eq!(paper < 200.0 && ink > 500.0, device.dark, "{device:?}: {paper} {ink}");
    assert_eq!(paper > 600.0 && ink < 200.0, !device.dark, "{device:?}: {paper} {ink}");
    assert_eq!(page.complaints(), [""; 0], "{device:?}");
}

#[test]
fn sample_pages_fit_their_windows() {
    let folder = tempfile::tempdir().unwrap();
    let files = ["comparison.html", "pyramid.html"].map(|name| folder.path().join(name));
    fs::write(&files[0], comparison_page(&sample::comparison(400, 300)).unwrap()).unwrap();
    fs::write(&files[1], pyramid_page(&sample::pyramid(160, 120)).unwrap()).unwrap();
    let Some(mut browser) = Browser::start(&[]) else { return };
    for device in [LAPTOP, PHONE] {
        for dark in [false, true] {
            let device = Device { dark, ..device };
            for file in &files {
                let mut page = browser.open(file, device);
                check(&mut page, device);
                let shade = if dark { "dark" } else { "light" };
                let name = file.file_stem().unwrap().to_string_lossy();
                let name = format!("{name}-{}-{shade}", device.name);
                keep(&mut page, &name);
                if album().is_none() {
                    continue;
                }
                for (state, keys) in [("split", "s"), ("flip", "sm"), ("relative", "m"), ("help", "m?")] {
                    keys.chars().for_each(|key| page.key(&key.to_string()));
                    keep(&mut page, &format!("{name}-{state}"));
                }
                check(&mut page, device);
            }
        }
    }
}

#[test]
fn empty_pages_open() {
    let folder = tempfile::tempdir().unwrap();
    let nothing = comparison_page(&Comparison::default()).unwrap();
    let one = sample::comparison(1, 1);
    let alone = Comparison { reference: None, insets: Vec::new(), ..one };
    let bare: Vec<Entry> =
        alone.entries.iter().map(|e| Entry { shown: e.shown.clone(), ..Entry::default() }).collect();
    let pages = [
        nothing,
        comparison_page(&alone).unwrap(),
        comparison_page(&Comparison { entries: bare, ..Comparison::default() }).unwrap(),
        pyramid_page(&Pyramid::default()).unwrap(),
        pyramid_page(&sample::pyramid(1, 1)).unwrap(),
    ];
    let Some(mut browser) = Browser::start(&[]) else { return };
    for (i, text) in pages.iter().enumerate() {
        let file = folder.path().join(format!("{i}.html"));
        fs::write(&file, text).unwrap();
        let mut page = browser.open(&file, LAPTOP);
        assert_eq!(page.complaints(), [""; 0], "page {i}");
        assert!(page.eval("document.querySelector('#trouble').hidden").as_bool().unwrap(), "page {i}");
    }
}
