//! The sky and the sun of Mitsuba's files.

use crate::common::{good, refused, warned};
use caustica_math::{Rgb, Vec3};
use caustica_scene::description::{Daylight, LightKind};

/// A scene with that emitter.
fn scene(inner: &str) -> String {
    format!(
        "<scene version='3.0.0'><sensor type='perspective'/>§<emitter type='sunsky'>{inner}</emitter></scene>"
    )
}

fn kinds(inner: &str) -> Vec<LightKind> {
    good(&scene(inner).replace('§', "")).lights.iter().map(|l| l.kind).collect()
}

fn to_sun(inner: &str) -> Vec3 {
    let LightKind::Sky { daylight, .. } = kinds(inner)[0] else { panic!("a sky") };
    daylight.to_sun.into()
}

const UP: &str = "<vector name='sun_direction' x='0' y='3' z='4'/>";

#[test]
fn a_sky_and_its_sun() {
    let [LightKind::Sky { daylight, albedo, scale }, sun] = kinds(UP)[..] else { panic!("two lamps") };
    assert_eq!((daylight.to_sun, daylight.turbidity), ([0.0, 3.0, 4.0], 3.0));
    assert_eq!((albedo, scale), (Rgb::splat(0.3), 1.0));
    assert_eq!(sun, LightKind::Sun { daylight, aperture: 0.5358, scale: 1.0, darkened: false });
    let all = "<float name='turbidity' value='7.5'/><rgb name='albedo' value='0.1 0.2 0.3'/>\
        <float name='sun_scale' value='0.5'/><float name='sky_scale' value='2'/>\
        <float name='sun_aperture' value='3'/><boolean name='complex_sun' value='true'/>\
        <transform name='to_world'><rotate x='1' angle='-90'/></transform>\
        <vector name='sun_direction' x='1' y='2' z='0'/>";
    let [LightKind::Sky { daylight, albedo, scale }, sun] = kinds(all)[..] else { panic!("two lamps") };
    let Daylight { to_world, to_sun, turbidity } = daylight;
    assert!((to_world.vector(Vec3::Z) - Vec3::Y).length() < 1e-6);
    // In the world, whatever the frame.
    assert_eq!((to_sun, turbidity, albedo, scale), ([1.0, 2.0, 0.0], 7.5, Rgb::new(0.1, 0.2, 0.3), 2.0));
    assert_eq!(sun, LightKind::Sun { daylight, aperture: 3.0, scale: 0.5, darkened: true });
}

#[test]
fn what_is_turned_off() {
    let off = |name: &str| format!("<float name='{name}' value='0'/>");
    assert!(matches!(kinds(&(UP.to_owned() + &off("sun_scale")))[..], [LightKind::Sky { .. }]));
    assert!(matches!(kinds(&(UP.to_owned() + &off("sky_scale")))[..], [LightKind::Sun { .. }]));
    let at_type = |inner: &str| scene(inner).replace('§', "").replace("'sunsky'", "'§sunsky'");
    let both = format!("{UP}{}{}", off("sun_scale"), off("sky_scale"));
    for (inner, message) in [
        (both.as_str(), "gives no light"),
        ("<vector name='sun_direction' x='0' y='1' z='-0.01'/>", "below the horizon"),
        ("<float name='hour' value='0'/>", "below the horizon"),
    ] {
        assert!(warned(&at_type(inner), message).lights.is_empty(), "{message}");
    }
}

/// Where Mitsuba has the sun; its 32 bits turn it by up to a tenth of a degree.
#[test]
fn the_sun_of_a_time_and_a_place() {
    let vienna = "<integer name='year' value='2024'/><integer name='month' value='12'/>\
        <integer name='day' value='21'/><float name='hour' value='12.5'/>\
        <float name='latitude' value='48.2'/><float name='longitude' value='16.37'/>\
        <float name='timezone' value='1'/>";
    let cape = "<integer name='year' value='2000'/><integer name='month' value='3'/>\
        <integer name='day' value='20'/><integer name='hour' value='7'/><float name='minute' value='30'/>\
        <float name='latitude' value='-33.9'/><float name='longitude' value='18.4'/>\
        <float name='timezone' value='2'/>";
    for (inner, theirs) in [
        ("", [0.0513854, 0.691748, 0.720308]),
        ("<float name='hour' value='8'/>", [-0.010881, -0.772856, 0.634488]),
        (vienna, [0.940111, 0.1482, 0.306965]),
        (cape, [-0.0872555, -0.987593, 0.130565]),
        (
            "<float name='hour' value='16.3'/><float name='minute' value='20'/><float name='second' value='30'/>",
            [-0.149403, 0.885102, 0.440765],
        ),
    ] {
        let off = (to_sun(inner) - Vec3::from(theirs)).length().to_degrees();
        assert!(off < 0.1, "{inner}: {off} degrees");
    }
    // In the frame, which turns it.
    let turned = "<transform name='to_world'><rotate x='1' angle='-90'/></transform>";
    let off = to_sun(turned) - Vec3::new(0.0513854, 0.720308, -0.691748);
    assert!(off.length().to_degrees() < 0.1, "{off:?}");
}

#[test]
fn bad_values() {
    for (inner, message) in [
        ("<float name='turbidity' value='§0.9'/>", "from 1 to 10"),
        ("<float name='turbidity' value='§11'/>", "from 1 to 10"),
        ("<rgb name='albedo' value='§0.5, 1.1, 0'/>", "from 0 to 1"),
        ("<float name='sun_scale' value='§-1'/>", "not negative"),
        ("<float name='sky_scale' value='§-1'/>", "not negative"),
        ("<float name='sun_aperture' value='§0'/>", "between 0 and 180"),
        ("<float name='sun_aperture' value='§180'/>", "between 0 and 180"),
        ("<integer name='month' value='§13'/>", "from 1 to 12"),
        ("<integer name='day' value='§0'/>", "from 1 to 31"),
        ("<float name='latitude' value='§91'/>", "from -90 to 90"),
        ("§<float name='complex_sun' value='1'/>", "must be a boolean"),
        ("<vector name='sun_direction' value='§0 0 0'/>", "no length"),
        (
            "<vector name='sun_direction' value='0 0 1'/>§<float name='hour' value='3'/>",
            "`sun_direction` and `hour` cannot both be given",
        ),
    ] {
        refused(&scene("INNER").replace('§', "").replace("INNER", inner), message);
    }
    let at = |inner: &str| scene("INNER").replace('§', "").replace("INNER", inner);
    warned(&at(&format!("{UP}<float name='sun_aperture' value='§0.001'/>")), "0.01°, which is taken");
    warned(&at(&format!("{UP}§<float name='turbidty' value='3'/>")), "did you mean `turbidity`?");
    warned(&at(&format!("{UP}§<float name='stretch' value='1'/>")), "unknown property `stretch`");
}
