//! What holds for all plugins of a Mitsuba scene: variables, references, versions, and the places of errors.

use std::path::Path;

use crate::common::{good, refused, warned};
use caustica_import::parse_mitsuba;
use caustica_math::Rgb;
use caustica_scene::description::{Geometry, LightKind, MaterialKind, Texture, TextureTransform};

fn scene(inner: &str) -> String {
    format!("<scene version='3.0.0'><sensor type='perspective'/>{inner}</scene>")
}

fn with(
    text: &str,
    variables: &[(&str, &str)],
) -> Result<caustica_import::Loaded, caustica_scene::Diagnostic> {
    let variables: Vec<(String, String)> =
        variables.iter().map(|(a, b)| ((*a).into(), (*b).into())).collect();
    parse_mitsuba(text, "scene.xml", Path::new("/nowhere"), &variables)
}

fn constant(value: &str) -> Rgb {
    let d = good(&scene(&format!("<emitter type='constant'>{value}</emitter>")));
    match d.lights[0].kind {
        LightKind::Constant { radiance } => radiance,
        other => panic!("{other:?}"),
    }
}

#[test]
fn variables() {
    refused(
        "<scene version='3.0.0'><default name='both' value='§${missing}'/></scene>",
        "the variable `$` has no value",
    );
    let text = "<scene version='3.0.0'><default name='s' value='3'/><default name='spp' value='$s1'/>\
        <sensor type='perspective'><sampler type='independent'><integer name='sample_count' value='$spp'/></sampler></sensor></scene>";
    let samples = |variables: &[(&str, &str)]| with(text, variables).map(|l| l.scene.unwrap().samples);
    // The longest name counts: `$spp` is not `$s` and `pp`.
    assert_eq!(samples(&[]), Ok(31));
    assert_eq!(samples(&[("spp", "12")]), Ok(12));
    assert_eq!(samples(&[("s", "5")]), Ok(51));
    let error = samples(&[("sppp", "1")]).unwrap_err();
    assert!(error.to_string().contains("no variable `sppp`") && error.hint.unwrap().contains("`spp`"));
    refused(&scene("<emitter type='§$kind'/>"), "-D kind=");
    let place = samples(&[("spp", "many")]).unwrap_err().origin.unwrap();
    assert_eq!((place.line, place.column as usize), (1, text.find("$spp").unwrap() + 1));
}

#[test]
fn references_and_aliases() {
    let text = scene(
        "<ref id='later'/><bsdf type='dielectric' id='glass'/><alias id='glass' as='window'/>\
        <shape type='cube'><ref id='window'/></shape><shape type='rectangle'><ref id='glass'/></shape>\
        <shape type='cube' id='later'/>",
    );
    let d = good(&text);
    assert_eq!(d.shapes[1].material, d.shapes[2].material);
    assert!(matches!(d.materials[d.shapes[1].material.0 as usize].kind, MaterialKind::Dielectric { .. }));
    let texture = scene(
        "<texture type='rgb' id='red'><rgb name='color' value='1 0 0'/></texture>\
        <shape type='cube'><bsdf type='diffuse'><ref name='reflectance' id='red'/></bsdf></shape>",
    );
    let red = MaterialKind::Diffuse { albedo: Rgb::new(1.0, 0.0, 0.0).into() };
    assert_eq!(good(&texture).materials[0].kind, red);
    refused(
        &scene("<bsdf type='diffuse' id='white'/><shape type='cube'><ref id='§whte'/></shape>"),
        "did you mean `white`?",
    );
    refused(&scene("<bsdf type='twosided' id='a'><ref id='§a'/></bsdf>"), "contains itself");
    refused(&scene("<bsdf type='diffuse' id='a'/>§<bsdf type='diffuse' id='a'/>"), "given again");
    refused(&scene("<alias id='§a' as='b'/>"), "nothing has the id `a`");
}

#[test]
fn colours() {
    assert_eq!(constant("<rgb name='radiance' value='1, 2 3'/>"), Rgb::new(1.0, 2.0, 3.0));
    assert_eq!(constant("<rgb name='radiance' value='#ff0000'/>"), Rgb::new(1.0, 0.0, 0.0));
    assert_eq!(constant("<spectrum name='radiance' value='2.5'/>"), Rgb::splat(2.5));
    assert_eq!(constant("<float name='radiance' value='2.5'/>"), Rgb::splat(2.5));
    let Rgb([r, g, b]) = constant("<srgb name='radiance' value='#bcbcbc'/>");
    assert!((r - 0.5029).abs() < 1e-3 && r == g && g == b, "{r}");
    let Rgb([r, g, b]) = constant("<spectrum name='radiance' value='400:0, 500:8, 600:15.6, 700:18.4'/>");
    assert!((r - 20.7).abs() < 0.1 && (g - 10.85).abs() < 0.05 && (b - 2.77).abs() < 0.02, "{r} {g} {b}");
    let Rgb([r, _, b]) = constant("<blackbody name='radiance' temperature='3000K'/>");
    assert!(r > b && b > 0.0);
    let lists = "<spectrum type='irregular' name='radiance'><string name='wavelengths' value='400 700'/>\
        <string name='values' value='1, 1'/></spectrum>";
    let pairs = "<spectrum name='radiance' value='400:1 700:1'/>";
    assert_eq!(constant(lists), constant(pairs));
    refused(
        &scene("<emitter type='constant'><rgb name='radiance' value='§-1'/></emitter>")
            .replace("'§", "§'")
            .replace("§'", "'§"),
        "not negative",
    );
    refused(
        &scene("<emitter type='constant'><spectrum name='radiance' value='400:1, §50:2x'/></emitter>"),
        "pair",
    );
    let green = "<shape type='cube'><bsdf type='diffuse'><spectrum name='reflectance' value='§500:0, 510:1, 520:0'/></bsdf></shape>";
    warned(&scene(green), "clipped");
}

#[test]
fn older_versions() {
    let text = "<scene version='0.6.0'><sensor type='perspective'><float name='nearClip' value='2'/>\
        <float name='fov' value='20'/><string name='fovAxis' value='x'/>\
        <transform name='toWorld'><lookAt origin='0,0,0' target='0,0,1' up='0,1,0'/></transform></sensor>\
        <integrator type='path'><integer name='maxDepth' value='4'/></integrator>\
        <shape type='sphere'><bsdf type='dielectric'><float name='intIOR' value='1.7'/></bsdf></shape>\
        <shape type='cube'><bsdf type='diffuse'><texture name='diffuseReflectance' type='checkerboard'>\
        <float name='uscale' value='4'/><float name='voffset' value='.5'/></texture></bsdf></shape>\
        <shape type='cube'><bsdf type='conductor'/></shape></scene>";
    let loaded = with(text, &[]).unwrap();
    assert_eq!((loaded.warnings, loaded.max_depth), (vec![], Some(4)));
    let d = loaded.scene.unwrap();
    assert_eq!(d.camera.near, 2.0);
    assert!(matches!(d.materials[0].kind, MaterialKind::Dielectric { interior_ior: 1.7, .. }));
    let MaterialKind::Diffuse { albedo: Texture::Checkerboard { scale, delta, .. } } = d.materials[1].kind
    else {
        panic!("{:?}", d.materials[1])
    };
    assert_eq!((scale, delta), ([0.125, -0.5], [-0.0, -3.0]));
    // Copper was what a metal was.
    let MaterialKind::Conductor { eta, .. } = d.materials[2].kind else { panic!() };
    assert_eq!(eta.0[0], 0.20044);
    // Today's names are no longer renewed.
    warned(
        &scene("<integrator type='path'>§<integer name='maxDepth' value='4'/></integrator>"),
        "unknown property `maxDepth`",
    );
}

#[test]
fn places_of_errors() {
    for (text, message) in [
        ("<scene version='§three'/>", "no version"),
        ("<scene version='3.0.0'>§<shpe type='cube'/></scene>", "did you mean <shape>?"),
        ("<scene version='3.0.0'>§<scale value='1'/></scene>", "inside of a <transform>"),
        ("<scene version='3.0.0'>\n  §hello</scene>", "stray text `hello`"),
        ("<scene version='3.0.0'>§<shape/></scene>", "lacks the attribute `type`"),
        ("<scene version='3.0.0'>§<float value='1'/></scene>", "lacks the attribute `name`"),
        ("<scene version='3.0.0'><float name='a' value='§x'/></scene>", "not a number"),
        ("<scene version='3.0.0'><integer name='a' value='§1.5'/></scene>", "not an integer"),
        ("<scene version='3.0.0'><boolean name='a' value='§yes'/></scene>", "not a boolean"),
        ("<scene version='3.0.0'><float name='a' §vlaue='1'/></scene>", "did you mean `value`?"),
        (
            "<scene version='3.0.0'><transform name='a'>§<scale value='0'/></transform></scene>",
            "no factor may be zero",
        ),
        ("<scene version='3.0.0'><transform name='a'><matrix value='§1 2'/></transform></scene>", "found 2"),
        (
            "<scene version='3.0.0'><transform name='a'>§<spin/></transform></scene>",
            "unknown transform operation",
        ),
        ("<scene version='3.0.0'><include filename='§missing.xml'/></scene>", "no such file"),
        ("<scene version='3.0.0'><path value='§missing'/></scene>", "no such folder"),
        (
            "<scene version='3.0.0'><shape type='cube'>§<path value='/'/></shape></scene>",
            "can only stand in <scene>",
        ),
        ("<scene version='3.0.0'><float name='a' unit='§ells' value='1'/></scene>", "unknown unit"),
        ("<scene version='3.0.0'><sensor type='perspective'>§</scene>", "expected </sensor>"),
    ] {
        refused(text, message);
    }
    refused(&scene("<shape type='sphere'><float name='radius' value='§-1'/></shape>"), "more than 0");
    refused(&scene("<shape type='sphere'>§<string name='radius' value='1'/></shape>"), "must be a float");
    refused(&scene("§<shape type='obj'/>"), "needs the string `filename`");
    refused(&scene("<shape type='obj'><string name='filename' value='§none.obj'/></shape>"), "no such file");
    refused(
        &scene("<shape type='cube'><bsdf type='diffuse'/>§<bsdf type='diffuse'/></shape>"),
        "more than one bsdf",
    );
}

#[test]
fn units_and_integers_where_numbers_are_meant() {
    let spot = |angle: &str| {
        let beam = "<float name='beam_width' value='45'/>";
        let d = good(&scene(&format!("<emitter type='spot'>{angle}{beam}</emitter>")));
        match d.lights[0].kind {
            LightKind::LinearSpot { outer_angle, .. } => outer_angle,
            _ => 0.0,
        }
    };
    assert_eq!(spot("<integer name='cutoff_angle' value='45'/>"), 45.0);
    assert_eq!(spot("<float name='cutoff_angle' unit='degrees' value='45'/>"), 45.0);
    let radians = "<emitter type='spot'><float name='cutoff_angle' unit='rad' value='.5'/></emitter>";
    let d = good(&scene(radians));
    let LightKind::LinearSpot { outer_angle, .. } = d.lights[0].kind else { panic!() };
    assert!((outer_angle - 28.6479).abs() < 1e-3, "{outer_angle}");
}

#[test]
fn files_of_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    std::fs::create_dir_all(folder.path().join("parts/meshes")).unwrap();
    write(
        "parts/camera.xml",
        "<scene version='0.6.0'><default name='w' value='9'/><sensor type='perspective'>\
        <film type='hdrfilm'><integer name='width' value='$w'/></film><float name='nearClip' value='3'/></sensor></scene>",
    );
    write("parts/glass.xml", "<bsdf type='dielectric' id='glass'/>");
    write("parts/meshes/a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 .25\nf 1/1 2/1 3/1\n");
    write("parts/lamp.spd", "400 1\n700 1\n");
    write(
        "main.xml",
        "<scene version='3.0.0'><path value='parts'/><include filename='camera.xml'/>\
        <include filename='glass.xml'/><shape type='obj'><string name='filename' value='meshes/a.obj'/><ref id='glass'/></shape>\
        <shape type='obj'><string name='filename' value='meshes/a.obj'/><boolean name='face_normals' value='true'/>\
        <boolean name='flip_tex_coords' value='false'/></shape>\
        <emitter type='constant'><spectrum name='radiance' filename='lamp.spd'/></emitter></scene>",
    );
    let loaded = caustica_import::load(&folder.path().join("main.xml")).unwrap();
    assert_eq!(loaded.warnings, []);
    let d = loaded.scene.unwrap();
    assert_eq!((d.film.width, d.camera.near), (9, 3.0));
    let Geometry::Mesh(smooth) = &d.shapes[0].geometry else { panic!() };
    let Geometry::Mesh(flat) = &d.shapes[1].geometry else { panic!() };
    assert!(smooth.normals.iter().all(|n| n.z == 1.0) && flat.normals.is_empty());
    assert_eq!((smooth.uvs[0].y, flat.uvs[0].y), (0.25, 0.75));
    write("parts/camera.xml", "<scene version='3.0.0'>\n<sensor type='none'/></scene>");
    let error = caustica_import::load(&folder.path().join("main.xml")).unwrap_err();
    let origin = error.origin.unwrap();
    assert!(origin.file.ends_with("camera.xml") && (origin.line, origin.column) == (2, 15), "{origin}");
    write("loop.xml", "<scene version='3.0.0'><include filename='loop.xml'/></scene>");
    let error = caustica_import::load(&folder.path().join("loop.xml")).unwrap_err();
    assert!(error.to_string().contains("include itself"), "{error}");
}

#[test]
fn later_folders_go_before_earlier_ones() {
    let folder = tempfile::tempdir().unwrap();
    for (name, width) in [("a", 1), ("b", 2)] {
        std::fs::create_dir(folder.path().join(name)).unwrap();
        let text = format!("<film type='hdrfilm'><integer name='width' value='{width}'/></film>");
        std::fs::write(folder.path().join(name).join("film.xml"), text).unwrap();
    }
    let text = "<scene version='3.0.0'><path value='a'/><path value='b'/>\
        <sensor type='perspective'><include filename='film.xml'/></sensor></scene>";
    let read = parse_mitsuba(text, "scene.xml", folder.path(), &[]).unwrap();
    assert_eq!(read.scene.unwrap().film.width, 2);
}

#[test]
fn environments_and_bitmaps() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.png");
    let mut encoder = png::Encoder::new(std::fs::File::create(&path).unwrap(), 4, 2);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(&[255, 0, 0, 0, 0, 0, 0, 0]).unwrap();
    let text = scene(
        "<emitter type='envmap'><string name='filename' value='map.png'/><float name='scale' value='2'/></emitter>\
        <shape type='rectangle'><bsdf type='diffuse'><texture type='bitmap' name='reflectance'>\
        <string name='filename' value='map.png'/><transform name='to_uv'><scale x='3' y='2'/><translate y='.25'/></transform>\
        </texture></bsdf></shape>",
    );
    let loaded = parse_mitsuba(&text, "scene.xml", folder.path(), &[]).unwrap();
    assert_eq!(loaded.warnings, []);
    let d = loaded.scene.unwrap();
    // One picture is read once.
    assert_eq!(d.images.len(), 1);
    let MaterialKind::Diffuse { albedo: Texture::Image { transform, .. } } = d.materials[0].kind else {
        panic!()
    };
    let (scale, offset) = ([3.0, 2.0], [0.0, -1.25]);
    assert_eq!(transform, TextureTransform { scale, offset, ..TextureTransform::default() });
    // Its bright pixel is the first of four: by Mitsuba's formula u = atan2(x, −z)/2π, an eighth of a turn from −z to +x.
    let scene = caustica_scene::Scene::new(d).unwrap().0;
    let seen = |x: f32, z: f32| {
        let direction = caustica_math::Vec3::new(x, 0.5, z).normalized();
        let rgb = caustica_math::Wavelengths::Rgb;
        let point = caustica_scene::light::LightPoint::infinite(0, direction);
        rgb.rgb(scene.lights(rgb).radiance(&point, -direction)).0[1]
    };
    assert!(seen(1.0, -1.0) > 0.9 && seen(-1.0, -1.0) < 0.2 && seen(1.0, 1.0) < 0.2 && seen(-1.0, 1.0) < 0.2);
}
