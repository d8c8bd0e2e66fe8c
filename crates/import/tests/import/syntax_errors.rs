//! What is wrong with a scene file whatever plugins it names.

use crate::common::{good, parse, refused, scene, warned};

fn refused_inside(marked: &str, fragment: &str) {
    refused(&scene(&format!("\n  {marked}\n")), fragment);
}

#[test]
fn malformed_xml() {
    refused("<scene>\n<camera type='perspective'>§</scene>", "expected </camera>");
    refused("<scene>\n<mesh§", "malformed XML");
    refused("<scene>\n  <mesh type='obj'>\n§", "before all of its tags are closed");
    refused("<scene>\n<a x=§1/></scene>", "malformed XML");
    refused("§", "malformed XML");
    refused("<scene name='x' §name='y'/>", "malformed XML");
}

#[test]
fn document_types_are_refused() {
    refused("<?xml version='1.0'?>\n§<!DOCTYPE s [<!ENTITY a 'b'>]><scene/>", "document type");
}

#[test]
fn the_root() {
    refused("§<mesh type='obj'/>", "must start with <scene>");
    refused("§<html/>", "unknown tag <html>");
}

#[test]
fn unknown_tags() {
    refused_inside("§<mash type='obj'/>", "did you mean <mesh>?");
    refused_inside("§<banana/>", "unknown tag <banana>");
    refused_inside("<mesh type='obj'>§<rotate angle='1' axis='1,0,0'/></mesh>", "inside of a <transform>");
    refused_inside(
        "<mesh type='sphere'><flaot §name='radius' value='1'/></mesh>"
            .replace('§', "")
            .replace("<flaot", "§<flaot")
            .as_str(),
        "did you mean <float>?",
    );
}

#[test]
fn attributes() {
    refused_inside("<mesh type='sphere' §colour='red'/>", "<mesh> has no attribute `colour`");
    refused_inside("§<mesh/>", "<mesh> lacks the attribute `type`");
    refused_inside("<mesh type='sphere'>§<float value='1'/></mesh>", "lacks the attribute `name`");
    refused_inside("<mesh type='sphere'>§<float name='radius'/></mesh>", "lacks the attribute `value`");
    refused_inside("<mesh type='sphere'><float name='radius' §vale='1'/></mesh>", "did you mean `value`?");
    refused_inside(
        "<mesh type='sphere'><transform name='toWorld'>§<rotate angle='1'/></transform></mesh>",
        "lacks the attribute `axis`",
    );
    refused_inside(
        "<mesh type='sphere'><transform name='toWorld'><scale §x='1'/></transform></mesh>",
        "<scale> has no attribute `x`",
    );
}

#[test]
fn stray_text() {
    refused_inside("<mesh type='sphere'>\n  §radius 3 </mesh>", "stray text `radius 3`");
    refused_inside("<mesh type='sphere'><float name='radius' value='1'>§x</float></mesh>", "stray text `x`");
    refused_inside("<mesh type='sphere'><transform name='toWorld'> §y</transform></mesh>", "stray text `y`");
}

#[test]
fn things_inside_of_values() {
    refused_inside(
        "<mesh type='sphere'><float name='radius' value='1'>§<mesh type='obj'/></float></mesh>",
        "nothing can stand inside <float>",
    );
    refused_inside(
        "<mesh type='sphere'><transform name='toWorld'><scale value='1,1,1'>§<float/></scale></transform></mesh>",
        "nothing can stand inside <scale>",
    );
}

#[test]
fn bad_values() {
    let sphere = |property: &str| format!("<mesh type='sphere'>{property}</mesh>");
    let refused_value = |property: &str, fragment: &str| refused_inside(&sphere(property), fragment);
    refused_value("<float name='radius' value='§abc'/>", "`abc` is not a number");
    refused_value("<float name='radius' value='§'/>", "not a number");
    refused_value("<float name='radius' value='§NaN'/>", "not a number");
    refused_value("<float name='radius' value='§1.5.2'/>", "not a number");
    refused_value("<float name='radius' value='§inf'/>", "must be finite");
    refused_value("<float name='radius' value='§1e60'/>", "must be finite");
    refused_value("<point name='center' value='0, §x, 1'/>", "`x` is not a number");
    refused_value("<point name='center' value='0 0 §nan'/>", "not finite");
    refused_value("<point name='center' value='0 §inf 0'/>", "not finite");
    refused_value("<point name='center' value='§1'/>", "expected 2 to 3 numbers and found 1");
    refused_value("<point name='center' value='§1 2 3 4'/>", "found 4");
    refused_value("<point name='center' value='§1 2'/>", "must have 3 coordinates, but has 2");
    refused_value("<point name='center' value='§1e60 2 3'/>", "too large");
    refused_value("<boolean name='b' value='§yes'/>", "not a boolean");
    refused_value("<color name='c' value='§1 2'/>", "expected 3 numbers and found 2");
    refused_inside(
        "<sampler type='independent'><integer name='sampleCount' value='§1.5'/></sampler>",
        "not an integer",
    );
    refused_inside(
        "<sampler type='independent'><integer name='sampleCount' value='§99999999999999999999'/></sampler>",
        "not an integer",
    );
}

#[test]
fn a_value_with_references_is_placed_as_a_whole() {
    refused_inside(
        "<mesh type='sphere'><point name='center' value='§&#48; x 1'/></mesh>",
        "`x` is not a number",
    );
}

#[test]
fn wrong_types_of_properties() {
    refused_inside(
        "<sampler type='independent'>§<float name='sampleCount' value='4'/></sampler>",
        "`sampleCount` must be an integer, but is a float",
    );
    refused_inside(
        "<mesh type='sphere'>§<integer name='radius' value='4'/></mesh>",
        "must be a float, but is an integer",
    );
    refused_inside("<mesh type='sphere'>§<vector name='center' value='0,0,0'/></mesh>", "must be a point");
    refused_inside("<mesh type='sphere'>§<string name='toWorld' value='1'/></mesh>", "must be a transform");
    refused_inside("<mesh type='obj'>§<float name='filename' value='1'/></mesh>", "must be a string");
    refused_inside(
        "<mesh type='sphere'><bsdf type='diffuse'>§<float name='albedo' value='1'/></bsdf></mesh>",
        "must be a color, but is a float",
    );
}

#[test]
fn transforms() {
    let refused_transform = |operation: &str, fragment: &str| {
        let mesh = format!("<mesh type='sphere'><transform name='toWorld'>{operation}</transform></mesh>");
        refused_inside(&mesh, fragment);
    };
    refused_transform("§<scale value='1, 0, 1'/>", "cannot be inverted");
    refused_transform("§<rotate angle='3' axis='0 0 0'/>", "the axis may not be zero");
    refused_transform("§<lookat origin='1 1 1' target='1 1 1' up='0 1 0'/>", "origin and target must differ");
    refused_transform("§<lookat origin='0 0 0' target='0 1 0' up='0 2 0'/>", "parallel");
    refused_transform("§<matrix value='1 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1'/>", "singular");
    refused_transform("<matrix value='§1 0 0'/>", "expected 16 numbers and found 3");
    refused_transform("<matrix value='§1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1'/>", "0 0 0 1");
    refused_transform("<rotate angle='§x' axis='0 0 1'/>", "not a number");
    refused_transform("<scale value='§2'/>", "expected 3 numbers");
    refused_transform("§<shear value='2'/>", "unknown transform operation <shear>");
    refused_transform("§<translte value='1 2 3'/>", "did you mean `translate`?");
}

#[test]
fn unknown_and_repeated_properties_are_warnings() {
    warned(
        &scene("\n<mesh type='sphere'>§<float name='raduis' value='2'/></mesh>"),
        "unknown property `raduis` of the mesh `sphere` (did you mean `radius`?)",
    );
    warned(&scene("§<float name='speed' value='2'/>"), "unknown property `speed` of the scene");
    let text = "<mesh type='sphere'>§<float name='radius' value='2'/><float name='radius' value='3'/></mesh>";
    let description = warned(&scene(text), "given again");
    let caustica_scene::description::Geometry::Sphere { radius, .. } = description.shapes[0].geometry else {
        panic!("no sphere")
    };
    assert_eq!(radius, 3.0);
}

#[test]
fn warnings_are_limited() {
    let many = "<float name='x' value='1'/>".repeat(5000);
    let warnings = parse(&scene(&many)).unwrap().warnings;
    assert_eq!(warnings.len(), 1001);
    assert!(warnings[1000].message.contains("more warnings"));
}

#[test]
fn comments_declarations_and_names_are_fine() {
    let text = "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!-- one = two -->\n".to_owned();
    good(&(text + &scene("<!-- x --><mesh type='sphere' id='a' name='b'><!-- y --></mesh>\n")));
    good("<scene type='scene' name='x'><camera type='perspective'/><integrator type='ao'/></scene>");
}

#[test]
fn too_much_of_anything() {
    let attributes: String = (0..300).map(|i| format!(" a{i}=''")).collect();
    refused(&format!("<scene>\n §<mesh{attributes}/></scene>"), "more than 256 attributes");
    let deep = "<mesh type='sphere'>".repeat(100_000);
    let error = parse(&scene(&deep)).unwrap_err().to_string();
    assert!(error.contains("malformed"), "{error}");
    let closed = format!("{deep}{}", "</mesh>".repeat(100_000));
    let error = parse(&scene(&closed)).unwrap_err().to_string();
    assert!(error.contains("nested too deeply"), "{error}");
    let comment = format!("<!-- {} -->", "=".repeat(1000));
    good(&scene(&comment));
    let names: String = (0..100).map(|i| format!("<mesh xmlns:a{i}='b'>")).collect();
    let error = parse(&scene(&names)).unwrap_err().to_string();
    assert!(error.contains("namespaces"), "{error}");
}
