//! The statistical tests that scene files carry.

use crate::common::parse;
use caustica_import::TestKind;
use caustica_scene::description::{LightKind, MaterialKind};

#[test]
fn t_tests_of_bsdfs() {
    let text = "<test type='ttest'><string name='angles' value='0 15, 30'/>\
        <string name='references' value='.1,.2,.3, .4,.5,.6'/>\
        <bsdf type='diffuse'/><bsdf type='mirror'/></test>";
    let loaded = parse(text).unwrap();
    assert!(loaded.scene.is_none() && loaded.warnings.is_empty());
    let test = &loaded.tests[0];
    assert!((test.significance - 0.01).abs() < 1e-9);
    let TestKind::TTest { sample_count, references, angles, scenes, .. } = &test.kind else { panic!() };
    assert_eq!(*sample_count, 100_000);
    assert_eq!(references[..], [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
    assert_eq!(angles[..], [0.0, 15.0, 30.0]);
    assert!(scenes.is_empty());
    assert_eq!(test.stage.materials.len(), 2);
    assert!(matches!(test.stage.materials[1].kind, MaterialKind::Mirror { .. }));
    assert_eq!(test.origin.as_ref().unwrap().to_string(), "scene.xml:1:1");
}

#[test]
fn t_tests_of_scenes() {
    let scene = |radius: u32| {
        format!(
            "<scene><camera type='perspective'/><integrator type='path_mis'/><mesh type='sphere'>\
            <float name='radius' value='{radius}'/></mesh></scene>"
        )
    };
    let text = format!(
        "<scene><test type='ttest'><integer name='sampleCount' value='50'/><float name='significanceLevel' value='.05'/>\
        <string name='references' value='1 2'/>{}{}</test></scene>",
        scene(1),
        scene(2)
    );
    let loaded = parse(&text).unwrap();
    let test = &loaded.tests[0];
    assert!((test.significance - 0.05).abs() < 1e-8);
    let TestKind::TTest { sample_count, references, scenes, .. } = &test.kind else { panic!() };
    assert_eq!((*sample_count, references.len(), scenes.len()), (50, 2, 2));
    assert_eq!(scenes[0].shapes.len(), 1);
    assert_ne!(scenes[0].shapes[0].geometry, scenes[1].shapes[0].geometry);
}

#[test]
fn t_tests_of_emitters() {
    let text = "<test type='ttest'><string name='distances' value='1 2'/><string name='references' value='1 .25'/>\
        <emitter type='point'><color name='power' value='1 1 1'/></emitter></test>";
    let test = parse(text).unwrap().tests.remove(0);
    let TestKind::TTest { distances, .. } = &test.kind else { panic!() };
    assert_eq!(distances[..], [1.0, 2.0]);
    assert!(matches!(test.stage.lights[0].kind, LightKind::Point { .. }));
}

#[test]
fn chi_square_tests() {
    let text = "<test type='chi2test'><bsdf type='diffuse'/></test>";
    let test = parse(text).unwrap().tests.remove(0);
    let TestKind::Chi2Test { resolution, min_exp_frequency, sample_count, test_count } = test.kind else {
        panic!()
    };
    assert_eq!((resolution, min_exp_frequency, sample_count, test_count), (10, 5, None, 5));
    let text = "<test type='chi2test'><bsdf type='diffuse'/><integer name='resolution' value='3'/>\
        <integer name='minExpFrequency' value='4'/><integer name='sampleCount' value='6'/>\
        <integer name='testCount' value='7'/></test>";
    let test = parse(text).unwrap().tests.remove(0);
    let TestKind::Chi2Test { resolution, min_exp_frequency, sample_count, test_count } = test.kind else {
        panic!()
    };
    assert_eq!((resolution, min_exp_frequency, sample_count, test_count), (3, 4, Some(6), 7));
}
