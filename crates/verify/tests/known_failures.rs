//! What other renderers are known to get wrong: a short run of every row's scene without a mismatch.

use caustica_render::Control;
use caustica_testkit::agreement::flatten;
use caustica_testkit::rows::rows;
use caustica_transport::Settings;
use caustica_verify::{Options, verify};

/// All rows together have a significance of 0.01.
#[test]
fn every_row_is_free_of_mismatches() {
    let rows = rows();
    let significance = 0.01 / rows.len() as f64;
    for row in rows {
        let settings = Settings { seed: 11, max_depth: Some(9), ..Settings::default() };
        let options = Options { settings, samples: 64, block: 4, significance, ..Options::default() };
        let outcome = verify(&flatten(row.scene), &options, &Control::default(), |_| ()).unwrap();
        for t in &outcome.tested {
            let (name, p) = (&t.estimator.name, t.smallest_p());
            assert!(t.mismatches == 0 && t.picture.invalid == 0, "{}: {name}, p = {p:.1e}", row.what);
        }
        // Something was tested on each.
        assert!(outcome.tested.iter().any(|t| t.tests() > 0), "{}", row.what);
    }
}

/// The table names a test for every row, and there is such a test.
#[test]
fn every_row_has_a_test_of_its_own() {
    for row in rows() {
        let (file, test) = row.test;
        let path = format!("{}/../transport/tests/{file}.rs", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains(&format!("#[test]\nfn {test}()")), "{}: {path} has no {test}", row.what);
    }
}

/// The published table has all rows with their tests.
#[test]
fn the_published_table_is_complete() {
    let path = format!("{}/../../docs/results.md", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    for row in rows() {
        let (file, test) = row.test;
        let shared = if row.shared { "shared: " } else { "" };
        let line = text.lines().find(|l| l.starts_with(&format!("| {} |", row.what)));
        let line = line.unwrap_or_else(|| panic!("{} is not in docs/results.md", row.what));
        assert!(line.ends_with(&format!("| 0 | {shared}`{file}::{test}` |")), "{line}");
    }
}
