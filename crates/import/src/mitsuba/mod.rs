//! Mitsuba's XML scenes.
//!
//! A file is read in three steps: XML to a tree of objects with typed properties ([`parse`]), where variables are
//! replaced, other files included and old names renewed; references to places in the tree ([`tree`]); then each
//! plugin reads its object through [`fields::Fields`], which keeps account of what nobody asked for.

mod bsdf;
mod cie;
mod class;
mod context;
mod emitter;
mod fields;
mod file;
mod film;
mod instance;
mod integrator;
mod ior;
mod parse;
mod paths;
mod plastic;
mod principled;
mod roughness;
mod scene;
mod sensor;
mod shape;
mod solids;
mod spectrum;
mod sunsky;
mod texture;
mod transform;
mod tree;
mod upgrade;
mod value;
mod wrapper;

use caustica_scene::Diagnostic;

use crate::Loaded;
use crate::files::Folder;
use crate::source::Source;
use crate::suggest;
use class::Class;
use context::Context;
use file::Variables;
use parse::Parser;
use paths::Paths;

/// Whether a text is a Mitsuba scene: its root is `<scene>` with a version. (Nori's has none.)
pub(crate) fn is_mitsuba(text: &str) -> bool {
    let mut rest = text.trim_start_matches('\u{feff}');
    loop {
        rest = rest.trim_start();
        let end = if rest.starts_with("<!--") {
            "-->"
        } else if rest.starts_with("<?") {
            "?>"
        } else {
            break;
        };
        let Some(at) = rest.find(end) else { return false };
        rest = &rest[at + end.len()..];
    }
    let Some(tag) = rest.strip_prefix("<scene").filter(|t| t.starts_with(char::is_whitespace)) else {
        return false;
    };
    let tag = &tag[..tag.find('>').unwrap_or(tag.len())];
    tag.match_indices("version").any(|(at, word)| {
        tag[..at].ends_with(char::is_whitespace) && tag[at + word.len()..].trim_start().starts_with('=')
    })
}

/// Reads the scene of a file, with values for its variables.
pub(crate) fn read(
    source: &Source,
    folder: Folder<'_>,
    variables: &[(String, String)],
) -> Result<Loaded, Diagnostic> {
    let mut parser = Parser::new(Variables::new(variables), Paths::new(folder));
    let root = parser.scene(source)?;
    if let Some(name) = parser.variables.unused().next() {
        let error = Diagnostic::error(format!("the scene has no variable `{}`", suggest::shorten(name)));
        let known = parser.variables.known();
        return Err(if known.is_empty() { error } else { error.hint(suggest::hint(name, &known)) });
    }
    let Parser { tree, paths, warnings, .. } = parser;
    debug_assert_eq!(tree.objects[root].class, Class::Scene);
    let mut context = Context::new(&tree, paths, warnings);
    scene::read(root, &mut context)?;
    let (max_depth, roulette_start) = (context.max_depth, context.roulette_start);
    let layers = std::mem::take(&mut context.layers);
    let (scene, warnings) = context.finish();
    Ok(Loaded { scene: Some(scene), tests: Vec::new(), warnings, max_depth, roulette_start, layers })
}

#[cfg(test)]
mod tests {
    use super::is_mitsuba;

    #[test]
    fn files_are_told_apart_by_their_roots() {
        for (text, expected) in [
            ("<scene version='3.0.0'>", true),
            ("\u{feff}<?xml version=\"1.0\"?>\n<!-- <scene> -->\n<scene\n\tversion = \"0.6.0\"/>", true),
            ("<?xml version='1.0'?><scene>", false),
            ("<scene subversion='1'/>", false),
            ("<scenery version='1'/>", false),
            ("<!-- <scene version='3.0.0'>", false),
            ("", false),
        ] {
            assert_eq!(is_mitsuba(text), expected, "{text}");
        }
    }
}
