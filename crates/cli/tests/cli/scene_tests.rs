use crate::bench::Bench;

/// A test of emission in closed form: a point light of power 4π has intensity 1.
fn ttest(reference: f64) -> String {
    format!(
        r#"<test type="ttest">
  <string name="distances" value="2"/>
  <string name="references" value="{reference}"/>
  <integer name="sampleCount" value="100"/>
  <emitter type="point"><color name="power" value="12.566371, 12.566371, 12.566371"/></emitter>
</test>
"#
    )
}

#[test]
fn tests_that_pass_exit_with_0_and_others_with_1() {
    let bench = Bench::new();
    bench.write("tests.xml", ttest(0.25));
    let ran = bench.run(&["test", "tests.xml"]).ok();
    assert!(ran.out.starts_with("ok    ttest 1"), "{}", ran.out);
    assert!(ran.out.ends_with("1 passed, 0 failed\n"), "{}", ran.out);
    bench.write("tests.xml", format!("<scene>{}{}</scene>", ttest(0.25), ttest(0.3)));
    let ran = bench.run(&["test", "tests.xml"]);
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(ran.out.contains("\nFAIL  ttest 2") && ran.out.contains("(tests.xml:"), "{}", ran.out);
    assert!(ran.out.ends_with("1 passed, 1 failed\n"), "{}", ran.out);
    let ran = bench.run(&["test", "tests.xml", "--json", "--seed", "2", "--threads", "1"]);
    let json = ran.json();
    assert_eq!((ran.code, &json["passed"], &json["failed"]), (Some(1), &1.into(), &1.into()));
    assert_eq!(
        (&json["outcomes"][0]["passed"], &json["outcomes"][1]["passed"]),
        (&true.into(), &false.into())
    );
    assert_eq!(json["warnings"], serde_json::json!([]));
}

#[test]
fn files_without_tests_and_files_without_scenes() {
    let bench = Bench::new();
    bench.run(&["test", "scene.xml"]).fails(3, &["`scene.xml` carries no tests", "help: tests are"]);
    bench.run(&["test", "none.xml"]).fails(3, &["there is no such file"]);
    bench.write("tests.xml", format!("<scene>{}</scene>", ttest(0.25)));
    for command in ["render", "info"] {
        bench
            .run(&[command, "tests.xml"])
            .fails(3, &["carries tests but no scene", "help: run it with `caustica test`"]);
    }
    assert_eq!(bench.made(), ["tests.xml"]);
}
