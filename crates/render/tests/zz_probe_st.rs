use std::path::Path;
use caustica_render::scene_tests::{TestOptions, run};
#[test]
fn probe() {
    for b in ["<bsdf type='roughconductor'><float name='alpha' value='.002'/></bsdf>", "<bsdf type='roughconductor'><float name='alpha' value='.0003'/></bsdf>","<bsdf type='roughdielectric'><float name='alpha' value='.001'/></bsdf>"] {
    let text = format!("<test type='chi2test'>{b}<integer name='sampleCount' value='50000'/></test>");
    let loaded = caustica_import::parse_nori(&text, "tests.xml", Path::new("")).unwrap();
    run(&loaded.tests, &TestOptions { seed:1, threads: Some(2) }, &mut |o| println!("{} {} {}", o.passed, o.name, o.detail)); 
    }
}
