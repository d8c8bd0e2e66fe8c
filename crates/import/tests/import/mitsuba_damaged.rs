//! Mitsuba scenes with one thing wrong each: where that is, and what the error says.

use crate::common::refused;

/// A whole scene on several lines, with `part` in place of one of its parts.
fn damaged(part: &str, with: &str) -> String {
    let scene = "<?xml version='1.0'?>
<!-- Ä scene. -->
<scene version='3.0.0'>
  <default name='spp' value='16'/>
  <integrator type='path'><integer name='max_depth' value='5'/></integrator>
  <sensor type='thinlens'>
    <float name='fov' value='40'/><float name='aperture_radius' value='.1'/><float name='focus_distance' value='3'/>
    <transform name='to_world'><lookat origin='0, 0, -5' target='0, 0, 0' up='0, 1, 0'/></transform>
    <film type='hdrfilm'><integer name='width' value='64'/><rfilter type='lanczos'><integer name='lobes' value='2'/></rfilter></film>
    <sampler type='independent'><integer name='sample_count' value='$spp'/></sampler>
  </sensor>
  <bsdf type='diffuse' id='wall'><rgb name='reflectance' value='.5, .4, .3'/></bsdf>
  <shape type='sphere' id='ball'><point name='center' x='1'/><float name='radius' value='2'/><ref id='wall'/></shape>
  <shape type='rectangle'><emitter type='area'><spectrum name='radiance' value='400:1, 700:2'/></emitter></shape>
</scene>";
    assert_eq!(scene.matches(part).count(), 1, "{part}");
    assert!(crate::common::parse(scene).is_ok_and(|l| l.warnings.is_empty()));
    scene.replace(part, with)
}

/// What is replaced, by what (with a mark where the error is), and a part of the error or of its hint.
type Row = (&'static str, &'static str, &'static str);

const DOCUMENT: &[Row] = &[
    ("</sensor>", "§</sensr>", "sensr"),
    ("<sampler type='independent'>", "§<samplr/><sampler type='independent'>", "did you mean <sampler>?"),
    ("</scene>", "§", ""),
    ("version='3.0.0'", "version='§three'", "is no version"),
    ("value='5'/>", "value=§5/>", ""),
    ("<ref id='wall'/>", "§loose<ref id='wall'/>", "stray text `loose`"),
    ("<ref id='wall'/>", "§&wall;", ""),
    ("<float name='fov' value='40'/>", "<float name='fov' value='40' §vale='1'/>", "did you mean `value`?"),
    ("<float name='fov' value='40'/>", "§<float value='40'/>", "lacks the attribute `name`"),
    ("<float name='fov' value='40'/>", "§<float name='fov'/>", "lacks the attribute `value`"),
    (
        "<float name='fov' value='40'/>",
        "<float name='fov' value='40'>§<rgb/></float>",
        "nothing can stand inside <float>",
    ),
    ("<film type='hdrfilm'>", "§<film>", "lacks the attribute `type`"),
];

const VALUES: &[Row] = &[
    ("name='fov' value='40'", "name='fov' value='§forty'", "is not a number"),
    ("name='fov' value='40'", "name='fov' value='§180'", "between 0 and 180"),
    ("name='fov' value='40'", "name='fov' value='§nan'", "is not"),
    ("name='fov' value='40'", "name='fov' value='§1e999'", "but is inf"),
    ("<float name='fov' value='40'/>", "§<string name='fov' value='40'/>", "must be a float"),
    ("value='.1'/>", "value='§-.1'/>", "not negative"),
    ("value='.1'/>", "value='§.1.2'/>", "not a number"),
    ("name='width' value='64'", "name='width' value='§0'", "from 1 to"),
    ("name='width' value='64'", "name='width' value='§6.4'", ""),
    ("name='width' value='64'", "name='width' value='§99999999'", "from 1 to 65536"),
    ("name='lobes' value='2'", "name='lobes' value='§0'", "from 1 to 32"),
    ("name='max_depth' value='5'", "name='max_depth' value='§-2'", "from -1"),
    ("value='$spp'", "value='§$ssp'", "did you mean `$spp`?"),
    ("origin='0, 0, -5'", "origin='§0, 0'", "3 numbers"),
    ("origin='0, 0, -5'", "", "lacks the attribute `origin`"),
    ("target='0, 0, 0'", "target='0, 0, -5'", "cannot be inverted"),
    ("<lookat ", "§<lokat ", "did you mean"),
    ("value='.5, .4, .3'", "value='§.5, .4'", "3 numbers"),
    ("value='.5, .4, .3'", "value='§#12345'", "is not a colour"),
    ("value='.5, .4, .3'", "value='§-.5, .4, .3'", "not negative"),
    ("value='400:1, 700:2'", "value='400:1, §700-2'", "is not a pair"),
    ("value='400:1, 700:2'", "value='§bright'", "neither a number"),
    ("<float name='radius' value='2'/>", "<float name='radius' value='§0'/>", "more than 0"),
    ("<point name='center' x='1'/>", "<point name='center' x='§one'/>", "not a number"),
];

const OBJECTS: &[Row] = &[
    ("type='path'", "type='§pat'", "did you mean `path`?"),
    ("type='thinlens'", "type='§thinlense'", "did you mean `thinlens`?"),
    ("type='thinlens'", "type='§distant'", "use one of perspective, thinlens"),
    ("type='hdrfilm'", "type='§hrdfilm'", "did you mean `hdrfilm`?"),
    ("type='lanczos'", "type='§lancos'", "did you mean `lanczos`?"),
    ("type='independent'", "type='§independant'", "did you mean `independent`?"),
    ("type='diffuse'", "type='§difuse'", "did you mean `diffuse`?"),
    ("type='sphere'", "type='§spere'", "did you mean `sphere`?"),
    ("type='area'", "type='§aera'", "did you mean `area`?"),
    ("<emitter type='area'>", "§<emitter type='point'>", "emitter can; put this one into the scene"),
    ("<ref id='wall'/>", "<ref id='§wal'/>", "did you mean `wall`?"),
    ("id='ball'", "id='wall'", "the id `wall` is given again"),
    ("<float name='focus_distance' value='3'/>", "", "needs the float `focus_distance`"),
    ("<ref id='wall'/>", "<ref id='wall'/>§<bsdf type='diffuse'/>", "more than one bsdf"),
    ("<sampler type", "§<film type='hdrfilm'/><sampler type", "more than one film"),
    (
        "<integer name='width' value='64'/>",
        "<integer name='crop_offset_x' value='900'/>",
        "crop window leaves",
    ),
    ("<default ", "<include filename='§none.xml'/><default ", "none.xml"),
    ("<default ", "<alias id='§floor' as='ground'/><default ", "nothing has the id `floor`"),
    ("<shape type='rectangle'>", "§<shape type='obj'>", "needs the string `filename`"),
    ("type='rectangle'>", "type='ply'><string name='filename' value='§none.ply'/>", "none.ply"),
];

/// Rows without a mark have their error at the object that the replaced part belongs to.
fn check(rows: &[Row], object: impl Fn(&str) -> &'static str) {
    let mut wrong = 0;
    for (part, with, message) in rows {
        let mut text = damaged(part, with);
        if !text.contains('§') {
            let object = object(message);
            assert_eq!(text.matches(object).count(), 1, "{object}");
            text = text.replace(object, &format!("§{object}"));
        }
        // All that is wrong is told, not the first row alone.
        wrong += u32::from(std::panic::catch_unwind(|| refused(&text, message)).is_err());
    }
    assert_eq!(wrong, 0, "rows are wrong");
}

#[test]
fn documents() {
    check(DOCUMENT, |_| "");
}

#[test]
fn values() {
    check(VALUES, |_| "<lookat");
}

#[test]
fn objects() {
    check(OBJECTS, |message| match message {
        "the id `wall` is given again" => "<shape type='sphere'",
        "crop window leaves" => "<film",
        _ => "<sensor",
    });
}

#[test]
fn there_are_enough() {
    assert!(DOCUMENT.len() + VALUES.len() + OBJECTS.len() >= 50);
}
