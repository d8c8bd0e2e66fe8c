use std::path::Path;
use caustica_render::scene_tests::{TestOptions, run};
#[test]
fn probe() {
    for (n, alpha) in [(200_000, 0.4), (2_000_000, 0.4), (2_000_000, 0.1)] {
    let text = format!("<test type='chi2test'><bsdf type='microfacet'><float name='alpha' value='{alpha}'/><color name='kd' value='.1 .2 .3'/></bsdf><integer name='sampleCount' value='{n}'/><integer name='testCount' value='20'/></test>");
    let loaded = caustica_import::parse_nori(&text, "tests.xml", Path::new("")).unwrap();
    for seed in [1, 2] { run(&loaded.tests, &TestOptions { seed, threads: Some(2) }, &mut |o| println!("{} {}", alpha, o.detail)); }
    }
}
