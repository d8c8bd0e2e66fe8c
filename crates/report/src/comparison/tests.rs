use super::*;

fn shown(name: &str, width: u32, height: u32) -> Shown {
    let pixels = vec![Rgb::new(0.25, 0.5, 1.0); (width * height) as usize];
    Shown { name: name.into(), width, height, pixels }
}

fn entry(name: &str, width: u32, height: u32) -> Entry {
    Entry { shown: shown(name, width, height), label: format!("<i>{name}</i>"), ..Entry::default() }
}

fn comparison() -> Comparison {
    Comparison {
        reference: Some(shown("reference", 3, 2)),
        entries: vec![entry("path", 3, 2)],
        ..Default::default()
    }
}

#[test]
fn odd_numbers_are_null_in_json() {
    let mut odd = comparison();
    odd.entries[0].metrics = Metrics {
        rel_mse: Some(f64::NAN),
        mean: f64::INFINITY,
        seconds: f64::NEG_INFINITY,
        ..Metrics::default()
    };
    odd.entries[0].slope = Some(f64::NAN);
    odd.entries[0].curve = vec![CurvePoint { seconds: 1.0, rel_mse: f64::INFINITY, ..CurvePoint::default() }];
    odd.speedups =
        vec![Speedup { faster: "a".into(), slower: "b".into(), factor: f64::NAN, at_least: false }];
    let json: serde_json::Value = serde_json::from_str(&comparison_json(&odd).unwrap()).unwrap();
    let entry = &json["entries"][0];
    for value in [&entry["metrics"]["rel_mse"], &entry["metrics"]["mean"], &entry["metrics"]["seconds"]] {
        assert!(value.is_null(), "{entry}");
    }
    assert!(entry["slope"].is_null() && entry["curve"][0]["rel_mse"].is_null());
    assert!(entry["shown"].get("pixels").is_none() && entry.get("flip_map").is_none());
    assert!(!comparison_page(&odd).unwrap().contains("times sooner"));
}

#[test]
fn strings_cannot_leave_their_place() {
    let evil = "</script><script>alert('x')</script>\u{2028}";
    let mut page = comparison();
    page.title = evil.into();
    page.scene = evil.into();
    page.notes = vec![(evil.into(), evil.into())];
    page.entries[0].label = evil.into();
    page.entries[0].shown.name = evil.into();
    page.speedups = vec![Speedup { faster: evil.into(), slower: evil.into(), factor: 14.2, at_least: true }];
    page.insets = vec![Inset { label: evil.into(), x: 0, y: 0, width: 1, height: 1 }];
    let html = comparison_page(&page).unwrap();
    assert!(!html.contains("<script>alert") && !html.contains("alert('x')</script>"));
    assert!(html.contains("\\u003c/script>"));
}

#[test]
fn nothing_comes_from_elsewhere() {
    let html = comparison_page(&comparison()).unwrap();
    for outside in ["src=\"http", "href=\"http", "url(http", "@import", "import("] {
        assert!(!html.contains(outside), "{outside}");
    }
}

#[test]
fn factors_have_two_digits() {
    let texts = [1.04, 9.94, 9.96, 14.4, 1234.5].map(factor_text);
    assert_eq!(texts, ["1.0", "9.9", "10", "14", "1234"]);
}

#[test]
fn little_is_enough() {
    assert!(comparison_page(&Comparison::default()).unwrap().contains("no images"));
    let alone = Comparison { reference: None, entries: vec![entry("only", 1, 1)], ..Comparison::default() };
    assert!(comparison_page(&alone).unwrap().contains("id=\"image-0\""));
}

#[test]
fn what_does_not_fit_is_an_error() {
    type Change = fn(&mut Comparison);
    let changed = |change: Change| {
        let mut c = comparison();
        change(&mut c);
        comparison_page(&c).unwrap_err().to_string()
    };
    let table: [(Change, &str); 6] = [
        (|c| c.entries[0].shown = shown("path", 2, 2), "`path` is 2 × 2, but `reference` is 3 × 2"),
        (|c| c.entries[0].shown.pixels.truncate(5), "`path` has 5 pixels, but 3 × 2"),
        (|c| c.entries[0].flip_map = Some(vec![0.0]), "`path (FLIP)` has 1 pixels"),
        (|c| c.insets = vec![Inset { x: 2, width: 2, height: 1, ..Inset::default() }], "is not inside"),
        (|c| c.insets = vec![Inset::default()], "is not inside"),
        (
            |c| {
                c.reference = None;
                c.entries[0].shown = shown("none", 0, 0);
            },
            "`none` has 0 pixels",
        ),
    ];
    for (change, expected) in table {
        let error = changed(change);
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn two_files_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("new/report");
    write_comparison(&comparison(), &inside).unwrap();
    let mut names: Vec<_> = fs::read_dir(&inside).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["index.html", "report.json"]);
    let blocked = inside.join("report.json");
    let error = write_comparison(&comparison(), &blocked).unwrap_err();
    assert!(matches!(error, ReportError::Folder { .. }), "{error}");
}

/// The best image's gains as sentences, all pairs in a table.
#[test]
fn gains_are_sentences_and_a_table() {
    let speedup = |faster: &str, slower: &str, factor| Speedup {
        faster: faster.into(),
        slower: slower.into(),
        factor,
        at_least: factor > 100.0,
    };
    let mut page = comparison();
    page.entries = ["naive", "path", "bdpt", "light"].map(|name| entry(name, 3, 2)).into();
    page.speedups = vec![
        speedup("path", "naive", 3.0),
        speedup("path", "bdpt", 0.25),
        speedup("bdpt", "naive", 120.0),
        speedup("bdpt", "path", 4.2),
        speedup("bdpt", "light", f64::NAN),
    ];
    let told = sentences(&page);
    let words: Vec<_> = told.iter().map(|s| (s.faster, s.slower, s.factor.as_str(), s.at_least)).collect();
    assert_eq!(words, [("bdpt", "naive", "120", true), ("bdpt", "path", "4.2", false)]);
    let times = Times::new(&page);
    assert_eq!(times.names, ["naive", "path", "bdpt"]);
    let row =
        |i: usize| times.rows[i].1.iter().map(|c| c.as_ref().map_or("–", |s| &s.factor)).collect::<Vec<_>>();
    assert_eq!([row(0), row(1), row(2)], [["–"; 3], ["3.0", "–", "0.2"], ["120", "4.2", "–"]]);
    let html = comparison_page(&page).unwrap();
    assert!(html.contains("bdpt</em> reaches") && !html.contains("path</em> reaches"), "{}", &html[..2000]);
    assert!(html.contains("&gt; 120× sooner"));
    page.speedups.clear();
    assert!(!comparison_page(&page).unwrap().contains("id=\"times\""));
}
