//! Running the statistical tests that scene files carry.

use std::path::Path;

use caustica_render::scene_tests::{Outcome, Summary, TestOptions, run};

fn run_file(text: &str, options: &TestOptions) -> (Vec<Outcome>, Summary) {
    let loaded =
        caustica_import::parse_nori(text, "tests.xml", Path::new(env!("CARGO_TARGET_TMPDIR"))).unwrap();
    let mut outcomes = Vec::new();
    let summary = run(&loaded.tests, options, &mut |o| outcomes.push(o.clone()));
    let passed = outcomes.iter().filter(|o| o.passed).count();
    assert_eq!(summary, Summary { passed, failed: outcomes.len() - passed });
    (outcomes, summary)
}

/// What comes of a file.
fn outcomes(text: &str) -> Vec<Outcome> {
    run_file(text, &TestOptions { seed: 1, threads: Some(2) }).0
}

#[track_caller]
fn assert_all_pass(text: &str, count: usize) {
    let outcomes = outcomes(text);
    assert_eq!(outcomes.len(), count);
    for o in &outcomes {
        assert!(o.passed, "{}: {}", o.name, o.detail);
    }
}

/// Asserts which of the outcomes pass.
#[track_caller]
fn assert_passed(text: &str, expected: &[bool]) {
    let outcomes = outcomes(text);
    let passed: Vec<bool> = outcomes.iter().map(|o| o.passed).collect();
    assert_eq!(passed, expected, "{outcomes:#?}");
}

fn ttest(angles: &str, references: &str, bsdfs: &str) -> String {
    format!(
        "<test type='ttest'><string name='angles' value='{angles}'/>\
         <string name='references' value='{references}'/>{bsdfs}</test>"
    )
}

fn dielectric(interior: f64, exterior: f64) -> String {
    format!(
        "<bsdf type='dielectric'><float name='intIOR' value='{interior}'/>\
         <float name='extIOR' value='{exterior}'/></bsdf>"
    )
}

const ANGLES: &str = "0 15 30 45 60 75 105 120 135 150 165 180";

/// The references of Nori's own file of tests.
#[test]
fn dielectrics_have_their_figures() {
    let air_to_glass = ".466874 .466918 .467719 .472557 .494179 .585174 1 1 1 2.179947 2.198289 2.19887";
    let glass_to_air = "2.761597 2.759731 2.677264 1 1 1 .530846 .424841 .397763 .391295 .390177 .390113";
    assert_all_pass(
        &format!(
            "<scene>{}{}</scene>",
            ttest(ANGLES, air_to_glass, &dielectric(1.5, 1.000277)),
            ttest(ANGLES, glass_to_air, &dielectric(1.000277, 1.7))
        ),
        24,
    );
    // Two BSDFs in one test: angles run faster.
    let both = dielectric(1.5, 1.000277) + &dielectric(1.000277, 1.7);
    assert_all_pass(&ttest("0 150", ".466874 2.179947 2.761597 .391295", &both), 4);
}

#[test]
fn microfacet_has_its_figures() {
    let microfacet = "<bsdf type='microfacet'><color name='kd' value='.1 .2 .15'/>\
                      <float name='intIOR' value='1.5'/></bsdf>";
    assert_all_pass(&ttest("0 45 60 80 85", ".207084 .215892 .247775 .430824 .519006", microfacet), 5);
    assert_passed(&ttest("0 85", ".24 .49", microfacet), &[false, false]);
}

/// The angle lies in the plane of x and z, and light is counted by luminance.
#[test]
fn weights_count_by_luminance() {
    let mirror = "<bsdf type='mirror'><color name='reflectance' value='1 .5 .25'/></bsdf>";
    assert_all_pass(&ttest("20", &(0.212671 + 0.5 * 0.71516 + 0.25 * 0.072169).to_string(), mirror), 1);
}

#[test]
fn wrong_references_fail() {
    let test = ttest("0 45 60", ".466874 .4727 .52", &dielectric(1.5, 1.000277));
    let outcomes = outcomes(&test);
    // The second is wrong by less than the samples can tell.
    assert_eq!(outcomes.iter().map(|o| o.passed).collect::<Vec<_>>(), [true, true, false]);
    assert_eq!(outcomes[2].name, "ttest 1, bsdf 1 (dielectric), 60°");
    assert!(outcomes[2].detail.contains("reference 0.520000"), "{}", outcomes[2].detail);
    assert_eq!(outcomes[2].origin.as_ref().unwrap().file, "tests.xml");
    // 1 − .99^(1/3).
    assert!(outcomes[0].detail.contains("α 0.003345"), "{}", outcomes[0].detail);
}

/// Φ/4πd², and what a square and a sphere send: their radiance times the solid angle that they fill.
#[test]
fn emitters_have_their_irradiance() {
    let point = "<emitter type='point'><color name='power' value='12 12 12'/></emitter>";
    let sphere =
        "<mesh type='sphere'><emitter type='area'><color name='radiance' value='3 3 3'/></emitter></mesh>";
    let sun = "<emitter type='directional'><vector name='direction' value='0 0 -1'/>\
               <color name='radiance' value='2 2 2'/></emitter>";
    let of_point = |d: f64| 12.0 / (4.0 * std::f64::consts::PI * d * d);
    let of_sphere = |d: f64| 6.0 * std::f64::consts::PI * (1.0 - (1.0 - 1.0 / (d * d)).sqrt());
    // The order of the file, whatever the emitters are.
    let test = |factor: f64| {
        let references = [of_sphere(2.0), of_sphere(5.0), of_point(2.0), of_point(5.0), 2.0, 2.0]
            .map(|r| (r * factor).to_string());
        format!(
            "<test type='ttest'><string name='distances' value='2, 5'/>\
             <string name='references' value='{}'/>{sphere}{point}{sun}</test>",
            references.join(" ")
        )
    };
    assert_all_pass(&test(1.0), 6);
    assert_passed(&test(1.01), &[false; 6]);
}

/// A cube with its normals inward, side 2.
fn write_cube(file: &str) {
    let mut text = String::new();
    for i in 0..8 {
        let side = |bit: i32| if i & bit == 0 { -1 } else { 1 };
        text += &format!("v {} {} {}\n", side(1), side(2), side(4));
    }
    text += "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
    std::fs::write(Path::new(env!("CARGO_TARGET_TMPDIR")).join(file), text).unwrap();
}

fn scene_test(reference: f64, samples: u32, scenes: &[String]) -> String {
    let references = vec![reference.to_string(); scenes.len()].join(" ");
    format!(
        "<test type='ttest'><string name='references' value='{references}'/>\
         <integer name='sampleCount' value='{samples}'/>{}</test>",
        scenes.concat()
    )
}

fn camera(fov: f64) -> String {
    format!(
        "<camera type='perspective'><float name='fov' value='{fov}'/><integer name='width' value='20'/>\
         <integer name='height' value='10'/></camera>"
    )
}

/// L/(1 − ρ) everywhere, by integrators without and with a light image.
#[test]
fn closed_furnace() {
    write_cube("furnace.obj");
    let furnace = |integrator: &&str| {
        format!(
            "<scene>{}<integrator type='{integrator}'/><mesh type='obj'>\
             <string name='filename' value='furnace.obj'/><bsdf type='diffuse'/>\
             <emitter type='area'><color name='radiance' value='1 1 1'/></emitter></mesh></scene>",
            camera(60.0)
        )
    };
    let scenes: Vec<String> = ["path_mats", "path_mis", "bdpt", "light"].iter().map(furnace).collect();
    assert_all_pass(&scene_test(2.0, 20_000, &scenes), 4);
    assert_passed(&scene_test(3.0, 20_000, &scenes), &[false; 4]);
}

/// A lamp above a floor that fills half of the picture: the mean is over all of it, background and borders,
/// and over all samples.
#[test]
fn point_light_on_a_floor() {
    let floor = "v -9 -9 4\nv 0 -9 4\nv 0 9 4\nv -9 9 4\nf 1 4 3 2\n";
    std::fs::write(Path::new(env!("CARGO_TARGET_TMPDIR")).join("floor.obj"), floor).unwrap();
    let scene = |integrator: &&str| {
        format!(
            "<scene>{}<integrator type='{integrator}'/><mesh type='obj'>\
             <string name='filename' value='floor.obj'/>\
             <bsdf type='diffuse'><color name='albedo' value='.8 .8 .8'/></bsdf></mesh>\
             <emitter type='point'><point name='position' value='0 0 2'/>\
             <color name='power' value='100 100 100'/></emitter></scene>",
            camera(1.0)
        )
    };
    // So far into the distance the picture is small: the light arrives along its axis.
    let radiance = 0.8 / std::f64::consts::PI * 100.0 / (4.0 * std::f64::consts::PI * 4.0);
    let scenes: Vec<String> = ["direct_ems", "whitted", "bdpt"].iter().map(scene).collect();
    assert_all_pass(&scene_test(0.5 * radiance, 20_000, &scenes), 3);
    assert_passed(&scene_test(0.52 * radiance, 20_000, &scenes), &[false; 3]);
}

/// What cannot be rendered fails, and says why.
#[test]
fn scenes_that_cannot_be_rendered_fail() {
    let scene = format!(
        "<scene>{}<integrator type='path_mis'/><mesh type='sphere'>\
         <transform name='toWorld'><scale value='1 2 1'/></transform></mesh></scene>",
        camera(60.0)
    );
    let outcomes = outcomes(&scene_test(0.0, 100, &[scene]));
    assert_eq!((outcomes.len(), outcomes[0].passed), (1, false));
    assert!(!outcomes[0].detail.contains("mean"), "{}", outcomes[0].detail);
    assert!(outcomes[0].origin.is_some());
}

/// Every BSDF with a density, and a level at which a hundred comparisons seldom fail by chance.
const ROUGH: &str = "<float name='significanceLevel' value='.001'/>\
    <bsdf type='diffuse'/><bsdf type='microfacet'/>\
    <bsdf type='microfacet'><float name='alpha' value='.4'/><color name='kd' value='.1 .2 .3'/></bsdf>\
    <bsdf type='roughconductor'><float name='alpha' value='.3'/></bsdf>\
    <bsdf type='roughdielectric'><float name='alpha' value='.3'/></bsdf>\
    <bsdf type='roughdielectric'><float name='alpha' value='.05'/></bsdf>";

#[test]
fn rough_bsdfs_pass_the_chi_square_test() {
    let test = format!(
        "<test type='chi2test'>{ROUGH}<integer name='sampleCount' value='200000'/>\
         <integer name='testCount' value='4'/></test>"
    );
    assert_all_pass(&test, 24);
}

/// Nori's own numbers: 200 cells, a million samples, five directions.
#[test]
fn chi_square_tests_have_defaults() {
    let outcomes = outcomes("<test type='chi2test'><bsdf type='diffuse'/></test>");
    assert_eq!(outcomes.len(), 5);
    for (i, o) in outcomes.iter().enumerate() {
        assert_eq!(o.name, format!("chi2test 1, bsdf 1 (diffuse), direction {}", i + 1));
        // A hundred cells of the hemisphere.
        assert!(o.passed && o.detail.contains(" 99 degrees"), "{}", o.detail);
        assert!(o.detail.contains(" α 0.002008, 1000000 samples"), "{}", o.detail);
    }
}

/// An odd number of rows puts the horizon within a row of cells, narrow lobes within one cell.
#[test]
fn any_resolution_will_do() {
    for resolution in [3, 7, 40] {
        let test = format!(
            "<test type='chi2test'>{ROUGH}<integer name='sampleCount' value='50000'/>\
             <integer name='testCount' value='1'/><integer name='resolution' value='{resolution}'/></test>"
        );
        assert_all_pass(&test, 6);
    }
}

/// A lobe a hundredth of a cell wide and without tails, which quadrature alone would miss.
#[test]
fn narrow_lobes_are_found() {
    let test = "<test type='chi2test'><bsdf type='microfacet'><float name='alpha' value='.002'/></bsdf>\
        <integer name='sampleCount' value='50000'/></test>";
    assert_all_pass(test, 5);
}

/// One cell would agree with anything.
#[test]
fn chi_square_tests_need_two_cells() {
    let test = "<test type='chi2test'><bsdf type='diffuse'/><integer name='sampleCount' value='4'/>\
        <integer name='testCount' value='1'/></test>";
    let outcomes = outcomes(test);
    assert!(
        !outcomes[0].passed && outcomes[0].detail.starts_with("fewer than two cells"),
        "{}",
        outcomes[0].detail
    );
}

#[test]
fn what_has_no_density_fails_the_chi_square_test() {
    let test = "<scene><test type='ttest'><string name='angles' value='0'/><string name='references' value='1'/>\
        <bsdf type='mirror'/></test>\n<test type='chi2test'>\n<bsdf type='mirror'/><bsdf type='dielectric'/>\
        <bsdf type='diffuse'><color name='albedo' value='0 0 0'/></bsdf>\
        <integer name='testCount' value='1'/></test></scene>";
    let outcomes = outcomes(test);
    let passed: Vec<bool> = outcomes.iter().map(|o| o.passed).collect();
    assert_eq!(passed, [true, false, false, false], "{outcomes:#?}");
    assert_eq!(outcomes[1].name, "chi2test 2, bsdf 1 (mirror)");
    assert!(outcomes[1].detail.contains("no density"), "{}", outcomes[1].detail);
    assert_eq!(outcomes[1].origin.as_ref().unwrap().line, 3);
}

#[test]
fn outcomes_do_not_depend_on_threads_but_on_the_seed() {
    write_cube("threads.obj");
    let scene = format!(
        "<scene>{}<integrator type='bdpt'/><mesh type='obj'><string name='filename' value='threads.obj'/>\
         <emitter type='area'><color name='radiance' value='1 1 1'/></emitter></mesh></scene>",
        camera(60.0)
    );
    let file = format!(
        "<scene>{}{}<test type='chi2test'><bsdf type='microfacet'/>\
         <integer name='sampleCount' value='70000'/><integer name='testCount' value='1'/></test></scene>",
        ttest("30", ".2", "<bsdf type='microfacet'/>"),
        scene_test(2.0, 70_000, &[scene])
    );
    let run = |seed, threads| run_file(&file, &TestOptions { seed, threads: Some(threads) }).0;
    let one = run(7, 1);
    assert_eq!(one.len(), 3);
    assert_eq!(one, run(7, 5));
    let other = run(8, 1);
    assert!(one.iter().zip(&other).all(|(a, b)| a.detail != b.detail));
}
