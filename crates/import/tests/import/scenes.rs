//! What scene files mean.

use crate::common::{good, parse, scene, warned};
use caustica_math::{Filter, Rgb, Transform, Vec3};
use caustica_scene::description::{
    CameraKind, Crop, Geometry, Integrator, LightKind, MaterialKind, Roughness, Technique, Texture,
};

fn material(bsdf: &str) -> MaterialKind {
    good(&scene(&format!("<mesh type='sphere'>{bsdf}</mesh>"))).materials[0].kind
}

fn light(emitter: &str) -> LightKind {
    good(&scene(emitter)).lights[0].kind
}

fn camera(kind: &str, inner: &str) -> caustica_scene::Description {
    good(&format!("<scene><camera type='{kind}'>{inner}</camera><integrator type='ao'/></scene>"))
}

#[test]
fn defaults() {
    let description = good(&scene(""));
    assert_eq!(description.camera.kind, CameraKind::Perspective { fov: 30.0 });
    assert_eq!((description.camera.near, description.camera.far), (1e-4, 1e4));
    assert_eq!((description.film.width, description.film.height), (1280, 720));
    assert_eq!(description.film.filter, Filter::Gaussian { radius: 2.0, stddev: 0.5 });
    assert_eq!(description.samples, 1);
    assert_eq!(description.camera.origin.unwrap().to_string(), "scene.xml:1:8");
}

#[test]
fn cameras() {
    let text = "<float name='fov' value='.5'/><integer name='width' value='7'/>\
        <integer name='height' value='5'/><float name='nearClip' value='1'/>\
        <float name='farClip' value='inf'/><rfilter type='mitchell'/>";
    let description = camera("perspective", text);
    assert_eq!(description.camera.kind, CameraKind::Perspective { fov: 0.5 });
    assert_eq!((description.film.width, description.film.height), (7, 5));
    assert_eq!((description.camera.near, description.camera.far), (1.0, f32::INFINITY));
    assert_eq!(description.film.filter, Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 });
    for names in [("apertureRadius", "focusDistance"), ("lensRadius", "focalDistance")] {
        let (radius, distance) = names;
        let lens = format!("<float name='{radius}' value='2'/><float name='{distance}' value='3'/>");
        let kind = CameraKind::ThinLens { fov: 30.0, aperture_radius: 2.0, focus_distance: 3.0 };
        assert_eq!(camera("thinlens", &lens).camera.kind, kind);
    }
    assert_eq!(camera("thinlens", "").camera.kind, CameraKind::Perspective { fov: 30.0 });
    assert_eq!(camera("orthographic", "").camera.kind, CameraKind::Orthographic);
    for name in ["environment", "spherical", "panoramic", "360"] {
        assert_eq!(camera(name, "").camera.kind, CameraKind::Environment);
    }
}

#[test]
fn films() {
    let film = "<film type='hdrfilm'><integer name='width' value='70'/><rfilter type='box'/>\
        <integer name='height' value='50'/><integer name='cropOffsetX' value='10'/>\
        <integer name='cropHeight' value='20'/></film>";
    let settings = camera("perspective", film).film;
    assert_eq!((settings.width, settings.height), (70, 50));
    assert_eq!(settings.filter, Filter::Box { radius: 0.5 });
    assert_eq!(settings.crop, Some(Crop { x: 10, y: 0, width: 60, height: 20 }));
}

#[test]
fn filters() {
    let filter = |text: &str| camera("perspective", text).film.filter;
    assert_eq!(filter("<rfilter type='tent'/>"), Filter::Tent { radius: 1.0 });
    let text = "<rfilter type='gaussian'><float name='radius' value='3'/>\
        <float name='stddev' value='1'/></rfilter>";
    assert_eq!(filter(text), Filter::Gaussian { radius: 3.0, stddev: 1.0 });
    let text = "<rfilter type='mitchell'><float name='B' value='0'/><float name='C' value='.5'/></rfilter>";
    assert_eq!(filter(text), Filter::Mitchell { radius: 2.0, b: 0.0, c: 0.5 });
}

#[test]
fn aliases_of_tags() {
    let text = "<scene><sensor type='perspective'/><integrator type='ao'/><sampler type='independent'>\
        <integer name='sampleCount' value='32'/></sampler><shape type='sphere'><bsdf type='diffuse'>\
        <rgb name='albedo' value='.1 .2,.3'/></bsdf></shape></scene>";
    let description = good(text);
    assert_eq!(description.samples, 32);
    let albedo = Texture::Constant(Rgb::new(0.1, 0.2, 0.3));
    assert_eq!(description.materials[0].kind, MaterialKind::Diffuse { albedo });
}

#[test]
fn transforms_apply_in_the_order_of_the_document() {
    let text = "<mesh type='sphere'><transform name='toWorld'><scale value='2 2 2'/>\
        <rotate angle='90' axis='0 0 1'/><translate value='1,0,0'/></transform></mesh>";
    let to_world = good(&scene(text)).shapes[0].to_world;
    assert!((to_world.point(Vec3::X) - Vec3::new(1.0, 2.0, 0.0)).length() < 1e-6);
    let text = "<mesh type='sphere'><transform name='toWorld'>\
        <matrix value='1 0 0 5, 0 1 0 6, 0 0 1 7, 0 0 0 1'/></transform></mesh>";
    assert_eq!(good(&scene(text)).shapes[0].to_world, Transform::translate([5.0, 6.0, 7.0]));
    let text = "<transform name='toWorld'><lookat origin='0,0,5' target='0,0,0' up='0,1,0'/></transform>";
    let expected = Transform::look_at([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0]);
    assert_eq!(camera("perspective", text).camera.to_world, expected);
    assert_eq!(camera("perspective", &text.replace("lookat", "lookAt")).camera.to_world, expected);
}

#[test]
fn spheres() {
    let text = "\n <mesh type='sphere'><point name='center' value='1 2 3'/><float name='radius' value='4'/></mesh>\
        <mesh type='sphere' id='ball'/>";
    let description = good(&scene(text));
    let geometry = Geometry::Sphere { center: Vec3::new(1.0, 2.0, 3.0), radius: 4.0 };
    assert_eq!(description.shapes[0].geometry, geometry);
    assert_eq!(
        (description.shapes[0].name.as_str(), description.shapes[1].name.as_str()),
        ("sphere", "ball")
    );
    let origin = description.shapes[0].origin.clone().unwrap();
    assert_eq!((origin.line, origin.column), (2, 2));
    // Both have the default material, which is one.
    assert_eq!(description.materials.len(), 1);
    let albedo = Texture::Constant(Rgb::splat(0.5));
    assert_eq!(description.materials[0].kind, MaterialKind::Diffuse { albedo });
}

#[test]
fn materials() {
    use MaterialKind::*;
    assert_eq!(material("<bsdf type='mirror'/>"), Mirror { reflectance: Rgb::WHITE });
    let (interior_ior, exterior_ior) = (1.5046, 1.000_277);
    assert_eq!(material("<bsdf type='dielectric'/>"), MaterialKind::dielectric(interior_ior, exterior_ior));
    let rough = MaterialKind::rough_dielectric(Roughness::ggx(0.1), interior_ior, exterior_ior);
    assert_eq!(material("<bsdf type='roughdielectric'/>"), rough);
    let kd = Texture::Constant(Rgb::splat(0.5));
    let microfacet = Microfacet { alpha: 0.1, interior_ior, exterior_ior, kd };
    assert_eq!(material("<bsdf type='microfacet'/>"), microfacet);
    let text =
        "<bsdf type='dielectric'><float name='intIOR' value='1.7'/><float name='extIOR' value='2'/></bsdf>";
    assert_eq!(material(text), MaterialKind::dielectric(1.7, 2.0));
}

#[test]
fn metals() {
    let (eta, k) = caustica_scene::bsdf::metals::metal("Au").unwrap();
    let text = "<bsdf type='conductor'><string name='material' value='Au'/></bsdf>";
    assert_eq!(material(text), MaterialKind::conductor(eta, k));
    let text = "<bsdf type='roughconductor'><color name='eta' value='1 2 3'/><color name='k' value='4 5 6'/>\
        <float name='extIOR' value='2'/><float name='alpha' value='.3'/></bsdf>";
    let (eta, k) = (Rgb::new(0.5, 1.0, 1.5), Rgb::new(2.0, 2.5, 3.0));
    let rough = MaterialKind::rough_conductor(Roughness::ggx(0.3), eta, k);
    assert_eq!(material(text), rough);
}

#[test]
fn textures() {
    let albedo = |texture: &str| match material(&format!("<bsdf type='diffuse'>{texture}</bsdf>")) {
        MaterialKind::Diffuse { albedo } => albedo,
        other => panic!("{other:?}"),
    };
    let text = "<texture type='constant_color' name='albedo'><color name='value' value='1 0 0'/></texture>";
    assert_eq!(albedo(text), Texture::Constant(Rgb::new(1.0, 0.0, 0.0)));
    let (value1, value2) = (Rgb::BLACK, Rgb::WHITE);
    let checkerboard =
        Texture::Checkerboard { delta: [0.0; 2], scale: [1.0; 2], shear: [0.0; 2], value1, value2 };
    assert_eq!(albedo("<texture type='checkerboard_color'/>"), checkerboard);
    let text = "<texture type='checkerboard_color' name='albedo'><point name='delta' value='.5, 1'/>\
        <vector name='scale' value='.1 .2'/><color name='value1' value='1 1 1'/></texture>";
    let checkerboard = Texture::Checkerboard {
        delta: [0.5, 1.0],
        scale: [0.1, 0.2],
        shear: [0.0; 2],
        value1: Rgb::WHITE,
        value2,
    };
    assert_eq!(albedo(text), checkerboard);
}

#[test]
fn area_lights() {
    let text =
        "<mesh type='sphere'><emitter type='area'><color name='radiance' value='10 20 30'/></emitter></mesh>";
    let radiance = Texture::Constant(Rgb::new(10.0, 20.0, 30.0));
    assert_eq!(good(&scene(text)).shapes[0].emission, Some(radiance));
}

#[test]
fn lights() {
    let pi = std::f32::consts::PI;
    let text = "<emitter type='point'><point name='position' value='1 2 3'/><color name='power' value='4 8 0'/></emitter>";
    let LightKind::Point { position, intensity } = light(text) else { panic!() };
    assert_eq!(position, [1.0, 2.0, 3.0]);
    assert!((intensity.0[0] - 1.0 / pi).abs() < 1e-6 && (intensity.0[1] - 2.0 / pi).abs() < 1e-6);
    for name in ["directional", "distant"] {
        let text = format!(
            "<emitter type='{name}'><vector name='direction' value='0 0 -2'/><color name='radiance' value='1 2 3'/></emitter>"
        );
        let irradiance = Rgb::new(1.0, 2.0, 3.0);
        assert_eq!(light(&text), LightKind::Directional { direction: [0.0, 0.0, -2.0], irradiance });
    }
    let text = "<emitter type='constant'><color name='radiance' value='1 1 1'/></emitter>";
    assert_eq!(light(text), LightKind::Constant { radiance: Rgb::WHITE });
}

#[test]
fn spot_lights() {
    for angles in [
        "<float name='totalWidth' value='60'/><float name='falloffStart' value='60'/>",
        "<float name='cosTotalWidth' value='.5'/><float name='cosFalloffStart' value='.5'/>",
        "<float name='outerAngle' value='60'/><float name='innerAngle' value='60'/>",
    ] {
        let text = format!(
            "<emitter type='spotlight'><point name='position' value='0 0 1'/><point name='target' value='0 0 0'/>\
            <color name='power' value='1 1 1'/>{angles}</emitter>"
        );
        let LightKind::Spot { direction, intensity, inner_angle, outer_angle, .. } = light(&text) else {
            panic!()
        };
        assert_eq!(direction, [0.0, 0.0, -1.0]);
        assert!((inner_angle - 60.0).abs() < 1e-4 && (outer_angle - 60.0).abs() < 1e-4);
        // A cone of half angle 60° has the solid angle π.
        assert!((intensity.0[0] * std::f32::consts::PI - 1.0).abs() < 1e-5);
    }
}

#[test]
fn integrators() {
    let integrator = |kind: &str| {
        let text = format!("<scene><camera type='perspective'/><integrator type='{kind}'/></scene>");
        good(&text).integrator
    };
    for (names, expected) in [
        (&["normals"] as &[_], Integrator::Normals),
        (&["depth"], Integrator::Depth),
        (&["ao"], Integrator::Ao),
        (&["whitted"], Integrator::Whitted),
        (&["direct_mats"], Integrator::Direct(Technique::Materials)),
        (&["direct_ems"], Integrator::Direct(Technique::Emitters)),
        (&["direct", "direct_mis"], Integrator::Direct(Technique::Mis)),
        (&["naive", "path_mats"], Integrator::Path(Technique::Materials)),
        (&["path_ems"], Integrator::Path(Technique::Emitters)),
        (&["path", "path_mis"], Integrator::Path(Technique::Mis)),
        (&["light"], Integrator::Light),
        (&["bdpt", "bidirectional"], Integrator::Bdpt),
    ] {
        for name in names {
            assert_eq!(integrator(name), expected, "{name}");
        }
    }
    let with = |inner: &str| good(&format!("<scene><camera type='perspective'/>{inner}</scene>")).integrator;
    let text = "<integrator type='av'><float name='length' value='.25'/></integrator>";
    assert_eq!(with(text), Integrator::Av { length: 0.25 });
    let text = "<integrator type='simple'><point name='position' value='-20 40 20'/>\
        <color name='energy' value='3.76e4 3.76e4 3.76e4'/></integrator>";
    let simple = Integrator::Simple { position: [-20.0, 40.0, 20.0], energy: Rgb::splat(3.76e4) };
    assert_eq!(with(text), simple);
    let text = "<integrator type='directional'><vector name='direction' value='1 0 0'/></integrator>";
    let directional = Integrator::Directional { direction: [1.0, 0.0, 0.0], irradiance: Rgb::WHITE };
    assert_eq!(with(text), directional);
}

#[test]
fn samplers_of_forks_are_taken_for_independent() {
    let text = "<sampler type='§halton'><integer name='sampleCount' value='9'/></sampler>";
    assert_eq!(warned(&scene(text), "`halton` is not supported").samples, 9);
}

#[test]
fn a_file_has_no_scene_if_it_is_empty_of_one() {
    let loaded = parse("<scene><test type='chi2test'><bsdf type='diffuse'/></test></scene>").unwrap();
    assert!(loaded.scene.is_none());
    let loaded = parse(&scene("<test type='chi2test'><bsdf type='diffuse'/></test>")).unwrap();
    assert!(loaded.scene.is_some() && loaded.tests.len() == 1);
}
