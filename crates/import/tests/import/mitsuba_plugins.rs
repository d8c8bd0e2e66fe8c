//! What each plugin of a Mitsuba scene becomes.

use crate::common::{good, parse, refused, warned};
use caustica_math::elementary::{atan2, tan};
use caustica_math::{Filter, Rgb, Vec3};
use caustica_scene::description::{
    CameraKind, Crop, Distribution, Geometry, Integrator, LightKind, MaterialKind, Principled,
    PrincipledThin, Roughness, Scalar, Shadowing, Technique, Texture,
};
use caustica_scene::{Description, Scene};

/// A scene with `inner` beside its sensor.
fn scene(inner: &str) -> String {
    format!(
        "<scene version='3.0.0'><sensor type='perspective'><float name='fov' value='40'/></sensor>{inner}</scene>"
    )
}

fn in_sensor(plugin: &str, inner: &str) -> String {
    format!("<scene version='3.0.0'><sensor type='{plugin}'>{inner}</sensor></scene>")
}

fn material(bsdf: &str) -> MaterialKind {
    good(&scene(&format!("<shape type='rectangle'>{bsdf}</shape>"))).materials[0].kind
}

fn fov(inner: &str) -> f32 {
    let film =
        "<film type='hdrfilm'><integer name='width' value='200'/><integer name='height' value='100'/></film>";
    match good(&in_sensor("perspective", &format!("{film}{inner}"))).camera.kind {
        CameraKind::Perspective { fov } => fov,
        other => panic!("{other:?}"),
    }
}

fn near(a: f32, b: f32) {
    assert!((a - b).abs() <= 1e-4 * b.abs(), "{a} {b}");
}

/// The whole angle, in degrees, whose half has that tangent.
fn angle(half: f32) -> f32 {
    2.0 * atan2(half, 1.0).to_degrees()
}

#[test]
fn fields_of_view() {
    let given =
        |axis: &str| fov(&format!("<float name='fov' value='40'/><string name='fov_axis' value='{axis}'/>"));
    assert_eq!((given("x"), given("larger")), (40.0, 40.0));
    let wide = angle(2.0 * tan(20.0_f32.to_radians()));
    near(given("y"), wide);
    near(given("smaller"), wide);
    let diagonal = tan(20.0_f32.to_radians()) * 2.0 / 5.0_f32.sqrt();
    near(given("diagonal"), angle(diagonal));
    // A film of 36 mm × 24 mm: 43.27 mm from corner to corner.
    let half = 43.266_6 / 2.0 / 35.0 * 2.0 / 5.0_f32.sqrt();
    near(fov("<string name='focal_length' value='35mm'/>"), angle(half));
    near(fov(""), fov("<string name='focal_length' value='50 mm'/>"));
}

#[test]
fn other_cameras() {
    let lens = "<float name='fov' value='30'/><float name='aperture_radius' value='.1'/>\
        <float name='focus_distance' value='3'/><float name='near_clip' value='1'/><float name='far_clip' value='9'/>";
    let camera = good(&in_sensor("thinlens", lens)).camera;
    let expected = CameraKind::ThinLens { fov: 30.0, aperture_radius: 0.1, focus_distance: 3.0 };
    assert_eq!((camera.kind, camera.near, camera.far), (expected, 1.0, 9.0));
    assert_eq!(good(&in_sensor("orthographic", "")).camera.kind, CameraKind::Orthographic);
}

#[test]
fn cameras_look_along_z_with_x_to_the_left() {
    let look = "<transform name='to_world'><lookat origin='0,0,-5' target='0,0,0' up='0,1,0'/></transform>";
    let camera = good(&in_sensor("perspective", look)).camera;
    let left = camera.to_world.vector(Vec3::X);
    // Looking along +z with +y up, the left of a right-handed world is +x.
    assert!((left - Vec3::X).length() < 1e-6, "{left:?}");
}

#[test]
fn films_filters_and_samplers() {
    let film =
        |inner: &str| good(&in_sensor("perspective", &format!("<film type='hdrfilm'>{inner}</film>"))).film;
    let usual = film("");
    assert_eq!((usual.width, usual.height, usual.crop), (768, 576, None));
    let crop = "<integer name='crop_offset_x' value='1'/><integer name='crop_offset_y' value='2'/>\
        <integer name='crop_width' value='3'/><integer name='crop_height' value='4'/>";
    assert_eq!(film(crop).crop, Some(Crop { x: 1, y: 2, width: 3, height: 4 }));
    for (filter, expected) in [
        ("type='box'/>", Filter::Box { radius: 0.5 }),
        ("type='tent'/>", Filter::Tent { radius: 1.0 }),
        ("type='gaussian'/>", Filter::Gaussian { radius: 2.0, stddev: 0.5 }),
        (
            "type='gaussian'><float name='stddev' value='1'/></rfilter>",
            Filter::Gaussian { radius: 4.0, stddev: 1.0 },
        ),
        ("type='mitchell'/>", Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 }),
        ("type='catmullrom'/>", Filter::Mitchell { radius: 2.0, b: 0.0, c: 0.5 }),
    ] {
        assert_eq!(film(&format!("<rfilter {filter}")).filter, expected);
    }
    let sampler = "<sampler type='multijitter'><integer name='sample_count' value='25'/></sampler>";
    assert_eq!(good(&in_sensor("perspective", sampler)).samples, 25);
    refused(
        &in_sensor("perspective", "<film type='hdrfilm'><rfilter type='§boxx'/></film>"),
        "did you mean `box`",
    );
}

#[test]
fn integrators_and_depths() {
    let read = |text: &str| {
        let loaded = parse(&scene(text)).unwrap();
        assert_eq!(loaded.warnings, []);
        (loaded.scene.unwrap().integrator, loaded.max_depth, loaded.roulette_start)
    };
    let path = Integrator::Path(Technique::Mis);
    assert_eq!(read(""), (path, None, None));
    let depths = "<integer name='max_depth' value='8'/><integer name='rr_depth' value='6'/>";
    assert_eq!(read(&format!("<integrator type='path'>{depths}</integrator>")), (path, Some(8), Some(6)));
    let unlimited = "<integrator type='path'><integer name='max_depth' value='-1'/></integrator>";
    assert_eq!(read(unlimited), (path, None, None));
    assert_eq!(read("<integrator type='ptracer'/>").0, Integrator::Light);
    assert_eq!(read("<integrator type='bdpt'/>").0, Integrator::Bdpt);
    assert_eq!(read("<integrator type='direct'/>"), (Integrator::Direct(Technique::Mis), Some(2), None));
    let lamps = "<integrator type='direct'><integer name='bsdf_samples' value='0'/></integrator>";
    assert_eq!(read(lamps).0, Integrator::Direct(Technique::Emitters));
    let text = scene("<integrator type='§moment'><integrator type='bdpt'/></integrator>");
    assert_eq!(warned(&text, "what is inside of it").integrator, Integrator::Bdpt);
    warned(&scene("<integrator type='§volpath'/>"), "`path` is used instead");
    refused(&scene("<integrator type='§paht'/>"), "did you mean `path`?");
}

#[test]
fn lamps_without_a_material_are_black() {
    let shape = |inside: &str| {
        let scene = good(&scene(&format!("<shape type='rectangle'>{inside}</shape>")));
        let material = scene.shapes.last().unwrap().material;
        scene.materials[material.0 as usize].kind
    };
    let diffuse = |albedo: f32| MaterialKind::Diffuse { albedo: Rgb::splat(albedo).into() };
    assert_eq!(shape("<emitter type='area'/>"), diffuse(0.0));
    assert_eq!(shape(""), diffuse(0.5));
    assert_eq!(shape("<emitter type='area'/><bsdf type='diffuse'/>"), diffuse(0.5));
}

#[test]
fn materials() {
    let grey = Rgb::splat(0.5);
    assert_eq!(material("<bsdf type='diffuse'/>"), MaterialKind::Diffuse { albedo: grey.into() });
    assert_eq!(material(""), MaterialKind::Diffuse { albedo: grey.into() });
    let glass = MaterialKind::dielectric(1.5046, 1.000_277);
    assert_eq!(material("<bsdf type='dielectric'/>"), glass);
    let named = "<bsdf type='dielectric'><string name='int_ior' value='Water'/><float name='ext_ior' value='1'/></bsdf>";
    assert_eq!(material(named), MaterialKind::dielectric(1.333, 1.0));
    let mirror = material("<bsdf type='conductor'/>");
    let MaterialKind::Conductor { eta, k, reflectance } = mirror else { panic!("{mirror:?}") };
    assert_eq!((eta, k, reflectance), (Rgb::BLACK, Rgb::WHITE, Rgb::WHITE.into()));
    let rough = "<bsdf type='roughconductor'><string name='material' value='Ni_palik'/><float name='alpha' value='.2'/>\
        <string name='distribution' value='ggx'/></bsdf>";
    let MaterialKind::RoughConductor { roughness, eta, .. } = material(rough) else { panic!() };
    assert_eq!(roughness, Roughness { shadowing: Shadowing::Separable, ..Roughness::ggx(0.2) });
    assert!(eta.0[0] > 2.0);
    let eta =
        "<bsdf type='conductor'><spectrum name='eta' value='0.789'/><rgb name='k' value='1 2 3'/></bsdf>";
    let MaterialKind::Conductor { eta, k, .. } = material(eta) else { panic!() };
    assert_eq!((eta, k), (Rgb::splat(0.789), Rgb::new(1.0, 2.0, 3.0)));
}

#[test]
fn roughness_by_direction_and_texture() {
    let rough = |inside: &str| {
        let text = format!("<bsdf type='roughdielectric'>{inside}</bsdf>");
        let MaterialKind::RoughDielectric { roughness, .. } = material(&text) else { panic!() };
        roughness
    };
    let beckmann =
        |alpha| Roughness { distribution: Distribution::Beckmann, shadowing: Shadowing::Separable, alpha };
    assert_eq!(rough(""), beckmann([0.1.into(); 2]));
    let both = "<float name='alpha_u' value='.2'/><float name='alpha_v' value='.4'/>";
    assert_eq!(rough(both), beckmann([0.2.into(), 0.4.into()]));
    let textured = rough("<texture name='alpha' type='checkerboard'/>");
    assert!(matches!(textured.alpha, [Scalar::Texture(Texture::Checkerboard { .. }), Scalar::Texture(_)]));
    let one = scene(
        "<shape type='cube'>§<bsdf type='roughdielectric'><float name='alpha_u' value='.2'/></bsdf></shape>",
    );
    refused(&one, "both `alpha_u` and `alpha_v`");
}

#[test]
fn factors_on_what_physics_says() {
    let inside = "<rgb name='specular_reflectance' value='.1 .2 .3'/>\
        <texture name='specular_transmittance' type='checkerboard'/>";
    let glass = material(&format!("<bsdf type='dielectric'>{inside}</bsdf>"));
    let MaterialKind::Dielectric { reflectance, transmittance, .. } = glass else { panic!() };
    assert_eq!(reflectance, Rgb::new(0.1, 0.2, 0.3).into());
    assert!(matches!(transmittance, Texture::Checkerboard { .. }));
}

#[test]
fn plastics() {
    let (interior_ior, exterior_ior) = (1.49, 1.000_277);
    let (diffuse, reflectance) = (Rgb::splat(0.5).into(), Rgb::WHITE.into());
    let smooth = MaterialKind::Plastic { interior_ior, exterior_ior, diffuse, reflectance, nonlinear: false };
    assert_eq!(material("<bsdf type='plastic'/>"), smooth);
    let inside = "<rgb name='diffuse_reflectance' value='.1 .2 .3'/><float name='int_ior' value='1.9'/>\
        <boolean name='nonlinear' value='true'/><float name='alpha' value='.2'/>\
        <string name='distribution' value='ggx'/>";
    let rough = material(&format!("<bsdf type='roughplastic'>{inside}</bsdf>"));
    let expected = MaterialKind::RoughPlastic {
        distribution: Distribution::Ggx,
        alpha: 0.2,
        interior_ior: 1.9,
        exterior_ior,
        diffuse: Rgb::new(0.1, 0.2, 0.3).into(),
        reflectance,
        nonlinear: true,
    };
    assert_eq!(rough, expected);
}

#[test]
fn principled_materials() {
    assert_eq!(material("<bsdf type='principled'/>"), MaterialKind::Principled(Principled::default()));
    let inside = "<float name='roughness' value='.2'/><float name='eta' value='1.4'/>\
        <texture name='metallic' type='checkerboard'/><float name='clearcoat_sampling_rate' value='2'/>";
    let MaterialKind::Principled(p) = material(&format!("<bsdf type='principled'>{inside}</bsdf>")) else {
        panic!()
    };
    assert_eq!((p.roughness, p.eta, p.sheen), (0.2.into(), 1.4, 0.0.into()));
    assert!(matches!(p.metallic, Scalar::Texture(Texture::Checkerboard { .. })));
    let glossy = "<bsdf type='principled'><float name='specular' value='.7'/></bsdf>";
    let MaterialKind::Principled(p) = material(glossy) else { panic!() };
    assert!((p.eta - 1.620_006_8).abs() < 1e-6);
    let thin = "<bsdf type='principledthin'><float name='diff_trans' value='1.5'/></bsdf>";
    let expected = PrincipledThin { diff_trans: 1.5.into(), ..PrincipledThin::default() };
    assert_eq!(material(thin), MaterialKind::PrincipledThin(expected));
    let bsdf = |inside: &str| scene(&format!("<shape type='cube'>{inside}</shape>"));
    let both =
        "§<bsdf type='principled'><float name='eta' value='1.4'/><float name='specular' value='.4'/></bsdf>";
    refused(&bsdf(both), "either `eta` or `specular`");
    refused(&bsdf("<bsdf type='principled'><float name='metallic' value='§2'/></bsdf>"), "metallic");
    warned(
        &bsdf("<bsdf type='principled'>§<float name='metalic' value='1'/></bsdf>"),
        "did you mean `metallic`?",
    );
}

#[test]
fn what_is_not_supported_is_told() {
    let told =
        |bsdf: &str, message: &str| warned(&scene(&format!("<shape type='cube'>{bsdf}</shape>")), message);
    told(
        "<bsdf type='roughdielectric'><string name='distribution' value='§phong'/></bsdf>",
        "`beckmann` is used",
    );
    let phong = "<bsdf type='§phong'><rgb name='diffuse_reflectance' value='.1 .2 .3'/><float name='n' value='2'/></bsdf>";
    let shown = told(phong, "shown as diffuse of its colour").materials[0].kind;
    assert_eq!(shown, MaterialKind::Diffuse { albedo: Rgb::new(0.1, 0.2, 0.3).into() });
    told("<bsdf type='§bumpmap'><texture type='checkerboard'/><bsdf type='diffuse'/></bsdf>", "it is flat");
    told("<bsdf type='§coating'><bsdf type='diffuse'/></bsdf>", "inside of it");
    told("<bsdf type='conductor'><string name='material' value='§AlSb'/></bsdf>", "no data of `AlSb`");
    warned(&scene("<emitter type='§timed_sunsky'/>"), "left out");
    warned(&scene("<shape type='§sdfgrid'/>"), "left out");
    warned(&scene("§<medium type='homogeneous'/>"), "participating media");
    warned(
        &scene("<shape type='cube'>§<float name='flip_normalz' value='1'/></shape>"),
        "did you mean `flip_normals`?",
    );
}

#[test]
fn unknown_plugins_have_suggestions() {
    for (text, hint) in [
        ("<shape type='§spere'/>", "did you mean `sphere`?"),
        ("<emitter type='§pont'/>", "did you mean `point`?"),
        ("<shape type='cube'><bsdf type='§difuse'/></shape>", "did you mean `diffuse`?"),
        (
            "<shape type='cube'><bsdf type='diffuse'><texture name='reflectance' type='§bitmp'/></bsdf></shape>",
            "bitmap",
        ),
        (
            "<shape type='cube'><bsdf type='dielectric'><string name='int_ior' value='§wate'/></bsdf></shape>",
            "`water`",
        ),
        (
            "<shape type='cube'><bsdf type='conductor'><string name='material' value='§Auu'/></bsdf></shape>",
            "`Au`",
        ),
        (
            "<shape type='cube'><bsdf type='conductor'><string name='material' value='§unobtainium'/></bsdf></shape>",
            "unknown metal",
        ),
    ] {
        refused(&scene(text), hint);
    }
    refused("<scene version='3.0.0'><sensor type='§perspektive'/></scene>", "did you mean `perspective`?");
    refused("§<scene version='3.0.0'/>", "no sensor");
}

#[test]
fn lights() {
    let light = |text: &str| good(&scene(text)).lights[0].kind;
    let point = "<emitter type='point'><point name='position' x='1' z='3'/><rgb name='intensity' value='2'/></emitter>";
    assert_eq!(light(point), LightKind::Point { position: [1.0, 0.0, 3.0], intensity: Rgb::splat(2.0) });
    let turned = "<emitter type='directional'><transform name='to_world'><rotate y='1' angle='90'/></transform>\
        <spectrum name='irradiance' value='3'/></emitter>";
    let LightKind::Directional { direction, irradiance } = light(turned) else { panic!() };
    assert!((direction[0] - 1.0).abs() < 1e-6 && irradiance == Rgb::splat(3.0));
    let sky = "<emitter type='constant'><spectrum type='d65' name='radiance'><float name='scale' value='4'/></spectrum></emitter>";
    assert_eq!(light(sky), LightKind::Constant { radiance: Rgb::splat(4.0) });
    let spot = "<emitter type='spot'><float name='cutoff_angle' value='30'/><float name='beam_width' value='30'/>\
        <transform name='to_world'><lookat origin='1,2,3' target='1,2,4' up='0,1,0'/></transform></emitter>";
    let LightKind::LinearSpot { to_world, inner_angle, outer_angle, picture: None, .. } = light(spot) else {
        panic!()
    };
    assert_eq!((to_world.point(Vec3::ZERO), to_world.vector(Vec3::Z)), (Vec3::new(1.0, 2.0, 3.0), Vec3::Z));
    assert_eq!((inner_angle, outer_angle), (30.0, 30.0));
    let checks = "<texture type='checkerboard' name='TEXTURE'/>";
    let behind = |angle: &str| {
        format!(
            "§<emitter type='spot'><float name='cutoff_angle' value='{angle}'/>{}</emitter>",
            checks.replace("TEXTURE", "texture")
        )
    };
    assert!(matches!(
        light(&behind("40").replace('§', "")),
        LightKind::LinearSpot { picture: Some(Texture::Checkerboard { .. }), inner_angle: 30.0, .. }
    ));
    refused(&scene(&behind("90")), "`cutoff_angle` below 90°");
    let projector = format!(
        "<emitter type='projector'><float name='fov' value='50'/><float name='scale' value='3'/>{}</emitter>",
        checks.replace("TEXTURE", "irradiance")
    );
    let LightKind::Projector { irradiance, scale, fov, aspect: 1.0, .. } = light(&projector) else {
        panic!()
    };
    assert!(
        fov == 50.0
            && scale == 3.0 * std::f32::consts::PI
            && matches!(irradiance, Texture::Checkerboard { .. })
    );
    let beam = good(&scene(
        "<shape type='sphere'/><shape type='rectangle'><emitter type='directionalarea'>\
         <rgb name='radiance' value='1 2 3'/></emitter></shape>",
    ));
    let exitance = Texture::Constant(Rgb::new(1.0, 2.0, 3.0));
    assert_eq!(beam.lights[0].kind, LightKind::Collimated { shape: 1, exitance });
    assert_eq!(beam.shapes[1].emission, None);
    refused(&scene("§<emitter type='directionalarea'/>"), "cannot stand alone");
    let area = good(&scene(
        "<shape type='rectangle'><emitter type='area'><rgb name='radiance' value='1 2 3'/></emitter></shape>",
    ));
    assert_eq!(area.shapes[0].emission, Some(Texture::Constant(Rgb::new(1.0, 2.0, 3.0))));
    refused(&scene("§<emitter type='area'/>"), "cannot stand alone");
}

/// Where the corners of a shape are in the world.
fn bounds(d: &Description, shape: usize) -> [Vec3; 2] {
    let s = &d.shapes[shape];
    let Geometry::Mesh(mesh) = &s.geometry else { panic!("a mesh") };
    let points = mesh.positions.iter().map(|p| s.to_world.point(*p));
    points
        .fold([Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY)], |[a, b], p| [a.min(p), b.max(p)])
}

#[test]
fn shapes_and_their_places() {
    let place = "<transform name='to_world'><scale x='2'/><rotate z='1' angle='90'/><translate value='10 0 0'/></transform>";
    let d = good(&scene(&format!("<shape type='cube' id='box'>{place}</shape><shape type='rectangle'/>")));
    let [low, high] = bounds(&d, 0);
    // Scaled first, then turned, then moved.
    assert!((low - Vec3::new(9.0, -2.0, -1.0)).length() < 1e-5, "{low:?}");
    assert!((high - Vec3::new(11.0, 2.0, 1.0)).length() < 1e-5, "{high:?}");
    assert_eq!((d.shapes[0].name.as_str(), d.shapes[1].name.as_str()), ("box", "rectangle"));
    let ball =
        "<shape type='sphere'><point name='center' value='1 2 3'/><float name='radius' value='.5'/></shape>";
    let d = good(&scene(ball));
    assert!(matches!(d.shapes[0].geometry, Geometry::Sphere { .. }));
    let pole = d.shapes[0].to_world.point(Vec3::Z);
    assert!((pole - Vec3::new(1.0, 2.0, 3.5)).length() < 1e-6, "{pole:?}");
    // Mitsuba's u is 0 at +x, ours at −x: the sphere is turned by half.
    let start = d.shapes[0].to_world.vector(-Vec3::X);
    assert!((start - Vec3::new(0.5, 0.0, 0.0)).length() < 1e-6, "{start:?}");
    let tube = "<shape type='cylinder'><point name='p0' value='0 0 1'/><point name='p1' value='0 4 1'/>\
        <float name='radius' value='.5'/></shape>";
    let [low, high] = bounds(&good(&scene(tube)), 0);
    assert!((low - Vec3::new(-0.5, 0.0, 0.5)).length() < 1e-3, "{low:?}");
    assert!((high - Vec3::new(0.5, 4.0, 1.5)).length() < 1e-3, "{high:?}");
}

#[test]
fn normals_are_flipped_on_meshes_and_spheres() {
    let flip = "<boolean name='flip_normals' value='true'/>";
    let d = good(&scene(&format!("<shape type='rectangle'>{flip}</shape>")));
    let Geometry::Mesh(mesh) = &d.shapes[0].geometry else { panic!() };
    assert!(mesh.normals.iter().all(|n| n.z == -1.0));
    let [a, b, c] = mesh.triangles[0].map(|i| mesh.positions[i as usize]);
    assert!((b - a).cross(c - a).z < 0.0);
    let d = good(&scene(&format!("<shape type='sphere'>{flip}</shape>")));
    let Geometry::Mesh(mesh) = &d.shapes[0].geometry else { panic!() };
    assert!(mesh.positions.iter().zip(&mesh.normals).all(|(p, n)| p.dot(*n) < 0.0));
    Scene::new(d).unwrap();
}

#[test]
fn textures_are_placed_for_v_upside_down() {
    let board = "<shape type='rectangle'><bsdf type='diffuse'><texture type='checkerboard' name='reflectance'>\
        <rgb name='color0' value='1'/><rgb name='color1' value='0'/>\
        <transform name='to_uv'><scale x='2' y='3'/><translate x='.25'/></transform></texture></bsdf></shape>";
    let d = good(&scene(board));
    let MaterialKind::Diffuse { albedo } = d.materials[0].kind else { panic!() };
    let table = caustica_scene::texture::TextureTable::new(&[]);
    for (u, v) in [(0.05, 0.05), (0.3, 0.1), (0.2, 0.4), (0.9, 0.8), (0.55, 0.95)] {
        // Mitsuba's: white where both coordinates lie in the same half of the unit.
        let half = |x: f32| x - x.floor() > 0.5;
        let white = half(2.0 * u + 0.25) == half(3.0 * v);
        let here = table.rgb(&albedo, caustica_math::Vec2::new(u, 1.0 - v));
        assert_eq!(here, Rgb::splat(f32::from(white)), "{u} {v}");
    }
}
