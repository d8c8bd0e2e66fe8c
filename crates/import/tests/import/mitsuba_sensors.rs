//! What sensors, films and integrators of a Mitsuba scene become.

use crate::common::{good, parse, refused, warned};
use caustica_math::{Filter, Vec3};
use caustica_scene::description::{CameraKind, Integrator, LayerKind, Technique};
use caustica_scene::{Description, Scene};

fn sensor(plugin: &str, inner: &str) -> String {
    format!("<scene version='3.0.0'><sensor type='{plugin}'>{inner}</sensor></scene>")
}

fn film(inner: &str) -> String {
    format!("<film type='hdrfilm'>{inner}</film>")
}

/// A scene with that integrator.
fn by(integrator: &str) -> String {
    format!("<scene version='3.0.0'>{integrator}<sensor type='perspective'/></scene>")
}

const PIXEL: Filter = Filter::Box { radius: 0.5 };

#[test]
fn principal_points() {
    let offset = "<float name='principal_point_offset_x' value='.25'/>\
        <float name='principal_point_offset_y' value='-.125'/>";
    assert_eq!(good(&sensor("perspective", offset)).camera.principal_point, [0.25, 0.625]);
    let lens = "<float name='aperture_radius' value='.1'/><float name='focus_distance' value='3'/>";
    assert_eq!(good(&sensor("thinlens", &format!("{offset}{lens}"))).camera.principal_point, [0.25, 0.625]);
    let parallel = "§<float name='principal_point_offset_x' value='.25'/>";
    warned(&sensor("orthographic", parallel), "unknown property `principal_point_offset_x`");
}

#[test]
fn sensors_of_old() {
    assert_eq!(good(&sensor("spherical", "")).camera.kind, CameraKind::Environment);
    let distorted = "<float name='fov' value='40'/>";
    let camera = warned(&sensor("§perspective_rdist", distorted), "`perspective` is used").camera;
    assert_eq!(camera.kind, CameraKind::Perspective { fov: 40.0 });
    assert_eq!(warned(&sensor("§telecentric", ""), "`orthographic`").camera.kind, CameraKind::Orthographic);
    refused(&sensor("§hdistant", ""), "use one of perspective");
}

#[test]
fn the_first_sensor_with_a_camera_is_used() {
    let two = |a: &str, b: &str| {
        format!("<scene version='3.0.0'>{a}<sensor type='distant'/>{b}<sensor type='orthographic'/></scene>")
    };
    assert_eq!(warned(&two("§", ""), "another one is used").camera.kind, CameraKind::Orthographic);
    let text = "<scene version='3.0.0'><sensor type='orthographic'/>§<sensor type='perspective'/></scene>";
    assert_eq!(warned(text, "only the first is used").camera.kind, CameraKind::Orthographic);
}

/// The ray of a radiance meter.
fn ray(inner: &str) -> (Vec3, Vec3) {
    let d = good(&sensor("radiancemeter", inner));
    assert_eq!((d.camera.kind, d.film.width, d.film.height), (CameraKind::RadianceMeter, 1, 1));
    assert_eq!((d.camera.near, d.camera.far, d.film.filter), (0.0, f32::INFINITY, PIXEL));
    let to_world = d.camera.to_world;
    (to_world.point(Vec3::ZERO), to_world.vector(Vec3::Z))
}

#[test]
fn radiance_meters() {
    assert_eq!(ray(""), (Vec3::ZERO, Vec3::Z));
    let given = "<point name='origin' value='1, 2, 3'/><vector name='direction' value='0, -3, 0'/>";
    let (origin, direction) = ray(given);
    assert!((origin - Vec3::new(1.0, 2.0, 3.0)).length() < 1e-6 && (direction + Vec3::Y).length() < 1e-6);
    let placed = "<transform name='to_world'><translate x='4'/></transform>";
    assert_eq!(ray(&format!("{given}{placed}")), (Vec3::new(4.0, 0.0, 0.0), Vec3::Z));
    refused(
        &sensor("radiancemeter", "<point name='origin' value='1, 2, 3'/>").replace("<sensor", "§<sensor"),
        "needs the vector `direction`",
    );
    let size = film("<integer name='width' value='8'/><rfilter type='box'/>");
    let d = warned(&sensor("§radiancemeter", &size), "one pixel");
    assert_eq!((d.film.width, d.film.height), (1, 1));
}

#[test]
fn irradiance_meters_stand_in_shapes() {
    let on = |plugin: &str, inner: &str| -> String {
        format!(
            "<scene version='3.0.0'><shape type='cube'/><shape type='{plugin}'>\
            <sensor type='irradiancemeter'>{inner}</sensor></shape><emitter type='constant'/></scene>"
        )
    };
    let kind = CameraKind::IrradianceMeter { shape: 1 };
    let check = |d: Description, size: [u32; 2]| {
        assert_eq!((d.camera.kind, [d.film.width, d.film.height]), (kind, size));
        let (scene, warnings) = Scene::new(d).unwrap();
        assert!(warnings.is_empty() && scene.camera.response() > 3.0, "{warnings:?}");
    };
    check(good(&on("sphere", "")), [1, 1]);
    let size = "<integer name='width' value='8'/><integer name='height' value='4'/>";
    check(good(&on("rectangle", &film(&format!("{size}<rfilter type='box'/>")))), [8, 4]);
    refused(&sensor("irradiancemeter", "").replace("<sensor", "§<sensor"), "into the `<shape>`");
    let placed = on("sphere", "<transform name='to_world'><translate x='4'/></transform>");
    refused(&placed.replace("<sensor", "§<sensor"), "no `to_world`");
}

#[test]
fn filters() {
    let read = |filter: &str| good(&sensor("perspective", &film(&format!("<rfilter {filter}")))).film.filter;
    assert_eq!(read("type='lanczos'/>"), Filter::Lanczos { lobes: 3 });
    assert_eq!(
        read("type='lanczos'><integer name='lobes' value='5'/></rfilter>"),
        Filter::Lanczos { lobes: 5 }
    );
    let cubic = "type='mitchell'><float name='B' value='.25'/><float name='C' value='.5'/></rfilter>";
    assert_eq!(read(cubic), Filter::Mitchell { radius: 2.0, b: 0.25, c: 0.5 });
    let old =
        format!("<scene version='0.6.0'><sensor type='perspective'>{}", film(&format!("<rfilter {cubic}")));
    let old = good(&format!("{old}</sensor></scene>")).film.filter;
    assert_eq!(old, Filter::Mitchell { radius: 2.0, b: 0.25, c: 0.5 });
    let radius = "<rfilter type='gaussian'>§<float name='radius' value='3'/></rfilter>";
    warned(&sensor("perspective", &film(radius)), "unknown property `radius`");
}

#[test]
fn lamps_can_be_hidden() {
    let hide = "<boolean name='hide_emitters' value='true'/>";
    assert!(!good(&by("<integrator type='path'/>")).camera.hides_lamps);
    for plugin in ["path", "direct", "ptracer"] {
        assert!(good(&by(&format!("<integrator type='{plugin}'>{hide}</integrator>"))).camera.hides_lamps);
    }
    let inner =
        format!("<integrator type='§moment'><integrator type='path'>{hide}</integrator></integrator>");
    assert!(warned(&by(&inner), "what is inside").camera.hides_lamps);
}

#[test]
fn channels_of_aov() {
    let aov = |channels: &str, inner: &str| {
        by(&format!("<integrator type='§aov'><string name='aovs' value='{channels}'/>{inner}</integrator>"))
    };
    let shown = |channels: &str| warned(&aov(channels, ""), "the picture shows").integrator;
    assert_eq!(shown("dd.y:depth,nn:sh_normal"), Integrator::Depth);
    assert_eq!(shown("uv:uv, nn:sh_normal"), Integrator::Normals);
    assert_eq!(shown("uv:uv"), Integrator::Depth);
    let text = aov("", "").replace('§', "").replace("<integrator", "§<integrator");
    refused(&text, "no layer that is known");
    // Around an integrator there is nothing to warn of, but for what is unknown.
    let around = |list: &str| {
        let list = format!("<string name='aovs' value={list}/><integrator type='direct'/>");
        by(&format!("<integrator type='aov'>{list}</integrator>"))
    };
    let loaded = parse(&around("'dd.y:depth, nn:sh_normal,uv:uv'")).unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    assert_eq!(loaded.scene.unwrap().integrator, Integrator::Direct(Technique::Mis));
    let layers: Vec<_> = loaded.layers.iter().map(|l| (l.name.as_str(), l.kind, l.v_down)).collect();
    let expected = [("dd.y", LayerKind::Depth), ("nn", LayerKind::ShadingNormal), ("uv", LayerKind::Uv)];
    assert_eq!(layers, expected.map(|(name, kind)| (name, kind, true)));
    warned(&around("'§a:depth,b:boundary_test'"), "no layer `boundary_test`");
    warned(&around("'§a:depth,b:albedo,a:depth'"), "two layers are called `a`");
    warned(&around("'§depth'"), "`depth` is not NAME:TYPE");
    warned(&around("'§eye:depth'"), "is there already");
    let many = (0..100_000).map(|i| format!("a{i}:depth,")).collect::<String>();
    warned(&around(&format!("'§{many}'")), "only the first 64 layers are looked at");
}

#[test]
fn names_of_old_versions() {
    let text = "<scene version='0.5.0'><integrator type='direct'><integer name='luminaireSamples' value='0'/>\
        <boolean name='hideEmitters' value='true'/></integrator><camera type='perspective'>\
        <float name='principalPointOffsetX' value='.25'/><float name='nearClip' value='2'/></camera></scene>";
    let d = good(text);
    assert_eq!(d.integrator, Integrator::Direct(Technique::Materials));
    assert_eq!((d.camera.principal_point, d.camera.near, d.camera.hides_lamps), ([0.25, 0.5], 2.0, true));
}

#[test]
fn depths_of_wrapped_integrators_count() {
    let text = by("<integrator type='moment'><integrator type='path'><integer name='max_depth' value='3'/>\
        <integer name='rr_depth' value='2'/></integrator></integrator>");
    let loaded = parse(&text).unwrap();
    assert_eq!((loaded.max_depth, loaded.roulette_start), (Some(3), Some(2)));
}
