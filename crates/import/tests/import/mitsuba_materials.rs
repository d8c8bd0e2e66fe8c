//! Materials made of others, thin glass, and how textures lie, in Mitsuba scenes.

use crate::common::{good, refused, warned};
use caustica_import::parse_mitsuba;
use caustica_math::{Rgb, Vec2};
use caustica_scene::description::{
    BumpRule, MaterialKind, PixelLookup, Texture, TextureTransform, Wrap, Wrapper,
};
use caustica_scene::texture::TextureTable;
use caustica_scene::{Description, Scene};

fn scene(inner: &str) -> String {
    format!(
        "<scene version='3.0.0'><sensor type='perspective'><float name='fov' value='40'/></sensor>{inner}</scene>"
    )
}

fn shape(bsdf: &str) -> String {
    scene(&format!("<shape type='rectangle'>{bsdf}</shape>"))
}

/// What the shape is made of, and all materials.
fn made(bsdf: &str) -> (MaterialKind, Description) {
    let d = good(&shape(bsdf));
    Scene::new(d.clone()).unwrap();
    (d.materials[d.shapes[0].material.0 as usize].kind, d)
}

fn wrapper(bsdf: &str) -> (Wrapper, Description) {
    match made(bsdf) {
        (MaterialKind::Wrapped(wrapper), d) => (wrapper, d),
        other => panic!("{other:?}"),
    }
}

/// The albedos of the materials inside.
fn albedos(wrapper: &Wrapper, d: &Description) -> Vec<f32> {
    let albedo = |kind: MaterialKind| match kind {
        MaterialKind::Diffuse { albedo: Texture::Constant(c) } => c.0[0],
        other => panic!("{other:?}"),
    };
    wrapper.inner().map(|id| albedo(d.materials[id.0 as usize].kind)).collect()
}

const DARK: &str = "<bsdf type='diffuse'><rgb name='reflectance' value='.125'/></bsdf>";
const LIGHT: &str = "<bsdf type='diffuse'><rgb name='reflectance' value='.75'/></bsdf>";

#[test]
fn wrappers() {
    let (found, d) = wrapper(&format!("<bsdf type='mask'>{DARK}</bsdf>"));
    assert!(matches!(found, Wrapper::Mask { opacity: Texture::Constant(Rgb([0.5, _, _])), .. }));
    assert_eq!(albedos(&found, &d), [0.125]);
    let (found, _) = wrapper(&format!("<bsdf type='mask'><float name='opacity' value='.25'/>{DARK}</bsdf>"));
    assert!(matches!(found, Wrapper::Mask { opacity: Texture::Constant(Rgb([0.25, _, _])), .. }));
    let blend =
        format!("<bsdf type='blendbsdf'><texture name='weight' type='checkerboard'/>{DARK}{LIGHT}</bsdf>");
    let (found, d) = wrapper(&blend);
    assert!(matches!(found, Wrapper::Blend { weight: Texture::Checkerboard { .. }, .. }));
    assert_eq!(albedos(&found, &d), [0.125, 0.75]);
    let (found, d) = wrapper(&format!("<bsdf type='twosided'>{DARK}</bsdf>"));
    assert_eq!(albedos(&found, &d), [0.125, 0.125]);
    let (found, d) = wrapper(&format!("<bsdf type='twosided'>{DARK}{LIGHT}</bsdf>"));
    assert_eq!(albedos(&found, &d), [0.125, 0.75]);
    let map = format!(
        "<bsdf type='normalmap'><rgb name='normalmap' value='.5 .5 1'/>\
        <boolean name='use_shadowing_function' value='false'/>{DARK}</bsdf>"
    );
    let (found, _) = wrapper(&map);
    let Wrapper::NormalMap { normals, rule, .. } = found else { panic!("{found:?}") };
    assert_eq!(normals, Rgb::new(0.5, 0.5, 1.0).into());
    assert_eq!(rule, BumpRule { flips: true, shadows: false });
}

#[test]
fn thin_glass_and_nothing() {
    let thin = "<bsdf type='thindielectric'><float name='int_ior' value='1.5'/><float name='ext_ior' value='1'/>\
        <rgb name='specular_transmittance' value='.5 .25 1'/></bsdf>";
    let (reflectance, transmittance) = (Rgb::WHITE.into(), Rgb::new(0.5, 0.25, 1.0).into());
    let expected =
        MaterialKind::ThinDielectric { interior_ior: 1.5, exterior_ior: 1.0, reflectance, transmittance };
    assert_eq!(made(thin).0, expected);
    assert_eq!(made("<bsdf type='null'/>").0, MaterialKind::Null);
}

#[test]
fn what_wrappers_need() {
    let fails = |bsdf: &str, message: &str| refused(&shape(bsdf), message);
    fails("§<bsdf type='mask'/>", "the bsdf `mask` needs one bsdf inside of it, and has 0");
    fails(&format!("§<bsdf type='mask'>{DARK}{DARK}</bsdf>"), "and has 2");
    fails(&format!("§<bsdf type='blendbsdf'>{DARK}{DARK}</bsdf>"), "needs a number or a texture `weight`");
    let one = format!("§<bsdf type='blendbsdf'><float name='weight' value='.5'/>{DARK}</bsdf>");
    fails(&one, "needs two bsdfs inside of it, and has 1");
    fails("§<bsdf type='twosided'/>", "one or two bsdfs");
    fails(&format!("§<bsdf type='bumpmap'>{DARK}</bsdf>"), "needs a texture");
    fails(&format!("§<bsdf type='normalmap'>{DARK}</bsdf>"), "`normalmap`");
    let board = format!("<bsdf type='§bumpmap'><texture type='checkerboard'/>{DARK}</bsdf>");
    warned(&shape(&board), "it is flat");
    // Mitsuba refuses it too.
    let d = good(&shape("<bsdf type='twosided'><bsdf type='dielectric'/></bsdf>"));
    assert!(Scene::new(d).unwrap_err().to_string().contains("light passes through"));
}

/// A picture of 2 × 2 pixels, 0 and 51 above 102 and 204, and what is made of a texture of it.
fn picture(inside: &str) -> (Texture, Description) {
    let folder = tempfile::tempdir().unwrap();
    let mut encoder = png::Encoder::new(std::fs::File::create(folder.path().join("p.png")).unwrap(), 2, 2);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(&[0, 51, 102, 204]).unwrap();
    let text = shape(&format!(
        "<bsdf type='bumpmap'><float name='scale' value='-3'/><texture name='any' type='bitmap'>\
        <string name='filename' value='p.png'/>{inside}</texture><bsdf type='diffuse'>\
        <texture type='bitmap' name='reflectance'><string name='filename' value='p.png'/></texture></bsdf></bsdf>"
    ));
    let loaded = parse_mitsuba(&text, "scene.xml", folder.path(), &[]).unwrap();
    assert_eq!(loaded.warnings, []);
    let d = loaded.scene.unwrap();
    let MaterialKind::Wrapped(Wrapper::Bump { height, scale, .. }) = d.materials[1].kind else { panic!() };
    assert_eq!(scale, -3.0);
    (height, d)
}

#[test]
fn raw_values_are_what_they_are() {
    let (texture, d) = picture("<boolean name='raw' value='true'/>");
    // The same file twice, once as colours.
    assert_eq!(d.images.len(), 2);
    let table = TextureTable::new(&d.images);
    let at = |u: f32, v: f32| table.rgb(&texture, Vec2::new(u, v)).0[0];
    assert_eq!([at(0.25, 0.75), at(0.75, 0.75), at(0.25, 0.25), at(0.75, 0.25)], [0.0, 0.2, 0.4, 0.8]);
    let MaterialKind::Diffuse { albedo } = d.materials[0].kind else { panic!() };
    assert!((table.rgb(&albedo, Vec2::new(0.75, 0.25)).0[0] - 0.6038).abs() < 1e-3);
    assert_eq!(picture("").1.images.len(), 1);
}

#[test]
fn wraps_and_filters() {
    let of = |inside: &str| match picture(inside).0 {
        Texture::Image { transform: TextureTransform { wrap, filter, .. }, .. } => (wrap, filter),
        other => panic!("{other:?}"),
    };
    assert_eq!(of(""), (Wrap::Repeat, PixelLookup::Bilinear));
    assert_eq!(of("<string name='wrap_mode' value='mirror'/>").0, Wrap::Mirror);
    assert_eq!(of("<string name='wrap_mode' value='clamp'/>").0, Wrap::Clamp);
    assert_eq!(of("<string name='filter_type' value='nearest'/>").1, PixelLookup::Nearest);
}

/// Where Mitsuba looks, by its own coordinates, whose v is 1 − v here: against the same picture looked up there.
#[test]
fn turned_textures() {
    let (plain, d) = picture("");
    let turned = "<transform name='to_uv'><rotate angle='30' z='1'/><scale x='2' y='3'/><translate x='.25' y='-.5'/></transform>";
    let (texture, _) = picture(turned);
    let board = format!(
        "<bsdf type='diffuse'><texture type='checkerboard' name='reflectance'>{turned}</texture></bsdf>"
    );
    let MaterialKind::Diffuse { albedo: board } = made(&board).0 else { panic!() };
    let quarter = turned.replace("30", "90");
    let quarter = format!(
        "<bsdf type='diffuse'><texture type='checkerboard' name='reflectance'>{quarter}</texture></bsdf>"
    );
    let MaterialKind::Diffuse { albedo: quarter } = made(&quarter).0 else { panic!() };
    let table = TextureTable::new(&d.images);
    let place = |angle: f32, u: f32, v: f32| {
        let (s, c) = caustica_math::elementary::sin_cos(angle.to_radians());
        [2.0 * (c * u - s * v) + 0.25, 3.0 * (s * u + c * v) - 0.5]
    };
    for i in 0..60 {
        let (u, v) = (i as f32 * 0.137 % 1.0, i as f32 * 0.071 % 1.0);
        let here = Vec2::new(u, 1.0 - v);
        let [x, y] = place(30.0, u, v);
        let expected = table.rgb(&plain, Vec2::new(x, 1.0 - y)).0[0];
        assert!((table.rgb(&texture, here).0[0] - expected).abs() < 1e-5, "{u} {v}");
        for (board, angle) in [(&board, 30.0), (&quarter, 90.0)] {
            let [x, y] = place(angle, u, v);
            let half = |x: f32| x - x.floor() > 0.5;
            let near = |x: f32| (2.0 * x - (2.0 * x).round()).abs() < 1e-4;
            let expected = if half(x) == half(y) { 0.4 } else { 0.2 };
            assert!(near(x) || near(y) || table.rgb(board, here).0[0] == expected, "{u} {v} {angle}");
        }
    }
    let flat = "<bsdf type='diffuse'><texture type='§checkerboard' name='reflectance'>\
        <transform name='to_uv'><rotate angle='90' x='1'/></transform></texture></bsdf>";
    warned(&shape(flat), "cannot be inverted");
}
