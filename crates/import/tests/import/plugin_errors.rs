//! What plugins refuse or warn of.

use crate::common::{refused, scene, warned};

fn refused_inside(marked: &str, fragment: &str) {
    refused(&scene(marked), fragment);
}

/// A scene with a camera that has these properties.
fn camera(kind: &str, inner: &str) -> String {
    format!("<scene><integrator type='ao'/>\n<camera type='{kind}'>{inner}</camera></scene>")
}

fn bsdf(marked: &str) -> String {
    scene(&format!("<mesh type='sphere'>{marked}</mesh>"))
}

#[test]
fn required_objects() {
    refused("§<scene><integrator type='ao'/></scene>", "the scene has no camera");
    refused("§<scene><camera type='perspective'/></scene>", "the scene has no integrator");
    refused("§<scene/>", "the scene has no camera");
}

#[test]
fn one_of_each() {
    refused_inside("§<camera type='perspective'/>", "the scene has more than one camera");
    refused_inside("§<integrator type='ao'/>", "the scene has more than one integrator");
    refused_inside("<sampler type='independent'/>§<sampler type='independent'/>", "more than one sampler");
    let diffuse = "<bsdf type='diffuse'/>";
    refused(&bsdf(&format!("{diffuse}§{diffuse}")), "the mesh `sphere` has more than one bsdf");
    refused(&camera("perspective", "<rfilter type='box'/>§<rfilter type='box'/>"), "more than one rfilter");
    let area = "<emitter type='area'><color name='radiance' value='1,1,1'/></emitter>";
    refused(&bsdf(&format!("{area}§{area}")), "more than one emitter");
}

#[test]
fn objects_in_the_wrong_place() {
    refused(
        &camera("perspective", "§<bsdf type='mirror'/>"),
        "a bsdf `mirror` cannot stand inside of a camera",
    );
    refused_inside("§<bsdf type='mirror'/>", "cannot stand inside of a scene");
    refused_inside("§<scene/>", "a scene cannot stand inside of a scene");
    refused_inside("§<rfilter type='box'/>", "cannot stand inside of a scene");
    refused(&bsdf("§<camera type='perspective'/>"), "cannot stand inside of a mesh");
    refused(
        &bsdf("<bsdf type='mirror'>§<texture type='constant_color' name='reflectance'/></bsdf>"),
        "a texture `constant_color` cannot stand inside of a bsdf `mirror`",
    );
    refused(
        &bsdf("<bsdf type='diffuse'>§<texture type='constant_color' name='roughness'/></bsdf>"),
        "cannot stand inside of a bsdf `diffuse`",
    );
    refused_inside("§<emitter type='area'/>", "cannot stand alone");
    refused(&bsdf("§<emitter type='point'/>"), "put this one into the scene");
}

#[test]
fn unknown_plugins() {
    refused(
        "<scene><camera type='§perspectve'/><integrator type='ao'/></scene>",
        "did you mean `perspective`?",
    );
    refused("<scene><camera type='perspective'/><integrator type='§pth'/></scene>", "did you mean `path`?");
    refused_inside("<mesh type='§cube'/>", "unknown mesh `cube` (known are obj, sphere)");
    refused_inside("<emitter type='§pont'/>", "did you mean `point`?");
    refused_inside("<sampler type='§random'/>", "unknown sampler `random`");
    refused_inside("<sampler type='§haltom'/>", "did you mean `halton`?");
    refused(&bsdf("<bsdf type='§plastic'/>"), "unknown bsdf `plastic`");
    refused(&bsdf("<emitter type='§aera'/>"), "unknown emitter `aera` (did you mean `area`?)");
    refused(&bsdf("<bsdf type='diffuse'><texture type='§marble'/></bsdf>"), "unknown texture `marble`");
    refused(&camera("perspective", "<rfilter type='§lanczos'/>"), "unknown rfilter `lanczos`");
    refused("<test type='§ztest'/>", "unknown test `ztest`");
}

/// Found by fuzzing random scenes: with lobes of 10³⁰ the weights of samples overflowed.
#[test]
fn lobes_of_filters_are_bounded() {
    let filter = |value| camera("perspective", &format!("<rfilter type='mitchell'>{value}</rfilter>"));
    refused(&filter("<float name='B' value='§1e30'/>"), "`B` must be between -100 and 100");
    refused(&filter("<float name='C' value='§-100'/>"), "`C` must be between -100 and 100");
}

#[test]
fn deliberately_unsupported() {
    refused(
        "<scene><camera type='perspective'/>\n<integrator type='§photonmapper'/></scene>",
        "the integrator `photonmapper` is not supported yet",
    );
    refused(&bsdf("<bsdf type='§disney'/>"), "the bsdf `disney` is not supported yet");
    refused(&bsdf("<bsdf type='§thindielectric'/>"), "not supported yet");
    refused_inside("<medium type='§homogeneous'/>", "the medium `homogeneous` is not supported yet");
    refused(&bsdf("<medium type='§heterogeneous'/>"), "not supported yet");
    refused_inside("<phase type='§hg'/>", "the phase `hg` is not supported yet");
}

#[test]
fn cameras() {
    for fov in ["0", "180", "-3", "1e9"] {
        refused(&camera("perspective", &format!("<float name='fov' value='§{fov}'/>")), "between 0 and 180");
    }
    for side in ["0", "-1", "65537", "4000000000"] {
        let marked = format!("<integer name='width' value='§{side}'/>");
        refused(&camera("perspective", &marked), "`width` must be from 1 to 65536");
    }
    let huge = "<integer name='width' value='65536'/><integer name='height' value='65536'/>";
    let text = camera("perspective", huge).replace("<camera", "§<camera");
    refused(&text, "more than the 268435456");
    let text = camera("perspective", "<float name='nearClip' value='5'/><float name='farClip' value='4'/>");
    refused(&text.replace("<camera", "§<camera"), "must be less than `farClip`");
    refused(&camera("perspective", "<float name='nearClip' value='§-5'/>"), "not negative");
    refused(&camera("perspective", "<float name='farClip' value='§-inf'/>"), "more than 0");
    refused(&camera("thinlens", "<float name='lensRadius' value='§-1'/>"), "not negative");
    refused(&camera("thinlens", "<float name='focalDistance' value='§0'/>"), "more than 0");
    let text = camera("thinlens", "<float name='apertureRadius' value='1'/>");
    refused(&text.replace("<camera", "§<camera"), "needs the float `focusDistance`");
    let crop = "<integer name='cropOffsetX' value='1000'/><integer name='cropWidth' value='281'/>";
    refused(&camera("perspective", crop).replace("<camera", "§<camera"), "leaves the picture");
}

#[test]
fn filters() {
    for radius in ["0", "-1", "33"] {
        let filter = format!("<rfilter type='tent'><float name='radius' value='§{radius}'/></rfilter>");
        refused(&camera("perspective", &filter), "at most 32");
    }
    let filter = "<rfilter type='gaussian'><float name='stddev' value='§0'/></rfilter>";
    refused(&camera("perspective", filter), "more than 0");
}

#[test]
fn samplers() {
    let sampler = |count: &str| {
        format!("<sampler type='independent'><integer name='sampleCount' value='§{count}'/></sampler>")
    };
    for count in ["0", "-1", "4294967296"] {
        refused_inside(&sampler(count), "`sampleCount` must be from 1");
    }
    warned(&scene("<sampler type='§stratified'/>"), "`independent` is used instead");
}

#[test]
fn shapes() {
    refused_inside("§<mesh type='obj'/>", "the mesh `obj` needs the string `filename`");
    refused_inside("<mesh type='obj'><string name='filename' value='§'/></mesh>", "`filename` is empty");
    refused_inside(
        "<mesh type='obj'><string name='filename' value='§gone.obj'/></mesh>",
        "cannot read the mesh `/nowhere/gone.obj`: there is no such file",
    );
    for radius in ["0", "-2"] {
        let marked = format!("<mesh type='sphere'><float name='radius' value='§{radius}'/></mesh>");
        refused_inside(&marked, "more than 0");
    }
}

#[test]
fn materials() {
    let property = |kind: &str, property: &str| bsdf(&format!("<bsdf type='{kind}'>{property}</bsdf>"));
    refused(&property("diffuse", "<color name='albedo' value='§-1,0,0'/>"), "not negative");
    refused(&property("diffuse", "<color name='albedo' value='0,§nan,0'/>"), "not finite");
    warned(&property("diffuse", "<color name='albedo' value='§2,0,0'/>"), "`albedo` is more than 1");
    warned(&property("mirror", "<color name='reflectance' value='§2,0,0'/>"), "more than 1");
    refused(&property("microfacet", "<color name='kd' value='§2,0,0'/>"), "may not be more than 1");
    for kind in ["dielectric", "roughdielectric", "microfacet"] {
        refused(&property(kind, "<float name='intIOR' value='§0'/>"), "more than 0");
        refused(&property(kind, "<float name='extIOR' value='§-1'/>"), "more than 0");
    }
    for kind in ["roughdielectric", "roughconductor", "microfacet"] {
        refused(&property(kind, "<float name='alpha' value='§0'/>"), "more than 0");
    }
    refused(&property("conductor", "<string name='material' value='§Xx'/>"), "unknown metal `Xx`");
    let half = property("conductor", "<color name='eta' value='1,1,1'/>").replace("<bsdf", "§<bsdf");
    refused(&half, "by both `eta` and `k`");
    warned(
        &property("roughconductor", "<string name='distribution' value='§beckmann'/>"),
        "`ggx` is used instead",
    );
}

#[test]
fn textures() {
    let texture = |inner: &str| bsdf(&format!("<bsdf type='diffuse'>{inner}</bsdf>"));
    refused(
        &texture("<color name='albedo' value='1,1,1'/><texture type='constant_color' name='albedo'/>")
            .replace("<bsdf", "§<bsdf"),
        "both a color and a texture",
    );
    refused(
        &texture("<texture type='checkerboard_color'><vector name='scale' value='§0, 1'/></texture>"),
        "`scale` may not be zero",
    );
    refused(
        &texture("<texture type='checkerboard_color'><point name='delta' value='§0, 1, 2'/></texture>"),
        "must have 2 coordinates",
    );
    refused(
        &texture("<texture type='image_texture'><string name='filename' value='§a.png'/></texture>"),
        "cannot read the image `/nowhere/a.png`",
    );
    refused(&texture("§<texture type='image_texture'/>"), "needs the string `filename`");
    refused(
        &texture(
            "<texture type='constant_color' name='albedo'/>§<texture type='constant_color' id='albedo'/>",
        ),
        "more than one texture",
    );
}

#[test]
fn lights() {
    let light = |kind: &str, inner: &str| scene(&format!("§<emitter type='{kind}'>{inner}</emitter>"));
    refused(&light("point", ""), "needs the color `power`");
    refused(&light("directional", ""), "needs the vector `direction`");
    refused(&light("distant", "<vector name='direction' value='0,0,1'/>"), "needs the color `radiance`");
    refused(&light("envmap", ""), "needs the string `filename`");
    refused(&light("constant", ""), "needs the color `radiance`");
    refused(&bsdf("§<emitter type='area'/>"), "needs the color `radiance`");
    let both = "<float name='power' value='1'/><float name='intensity' value='1'/>";
    refused(&light("point", both), "not both");
    let unmarked = |kind: &str, inner: &str| scene(&format!("<emitter type='{kind}'>{inner}</emitter>"));
    refused(&unmarked("directional", "<vector name='direction' value='§0,0,0'/>"), "has no length");
    refused(&unmarked("point", "<color name='power' value='§-1,0,0'/>"), "not negative");
    refused(&unmarked("point", "§<string name='power' value='1'/>"), "must be a color");
    let aim = "<vector name='direction' value='0,0,1'/><float name='power' value='1'/>";
    refused(&light("spot", aim), "needs the float `outerAngle`");
    let angles = "<float name='outerAngle' value='10'/><float name='innerAngle' value='20'/>";
    refused(&light("spot", &format!("{aim}{angles}")), "is more than the outer one");
    refused(&light("spot", "<point name='target' value='0,0,0'/>"), "are the same");
    refused(&unmarked("spot", &format!("{aim}<float name='outerAngle' value='§181'/>")), "at most 180");
}

#[test]
fn integrators() {
    let integrator = |kind: &str, inner: &str| {
        format!(
            "<scene><camera type='perspective'/>\n§<integrator type='{kind}'>{inner}</integrator></scene>"
        )
    };
    refused(&integrator("av", ""), "needs the float `length`");
    refused(&integrator("simple", ""), "needs the point `position`");
    refused(&integrator("simple", "<point name='position' value='0,0,0'/>"), "needs the color `energy`");
    refused(&integrator("directional", ""), "needs the vector `direction`");
}

#[test]
fn tests() {
    let ttest = |inner: &str| format!("<scene>\n§<test type='ttest'>{inner}</test></scene>");
    refused(&ttest(""), "nothing to test");
    let bsdf = "<bsdf type='diffuse'/>";
    refused(&ttest(&format!("{bsdf}<string name='angles' value='0 1'/>")), "has 0 references and needs 2");
    let lists = "<string name='angles' value='0'/><string name='references' value='1 2'/>";
    refused(&ttest(&format!("{bsdf}{lists}")), "has 2 references and needs 1");
    let scene = "<scene><camera type='perspective'/><integrator type='ao'/></scene>";
    refused(&ttest(&format!("{bsdf}{scene}")), "not about several");
    refused(&format!("§<test type='chi2test'>{scene}</test>"), "tests BSDFs");
    refused("§<test type='chi2test'/>", "nothing to test");
    refused("<test type='ttest'>§<scene/></test>", "no camera");
    refused(
        "<test type='ttest'><bsdf type='diffuse'/><string name='references' value='§1, x'/></test>",
        "`x` is not a number",
    );
    refused("<test type='ttest'><float name='significanceLevel' value='§1'/></test>", "between 0 and 1");
    refused(
        "<test type='chi2test'><bsdf type='diffuse'/><integer name='resolution' value='§0'/></test>",
        "`resolution` must be from 1",
    );
}
