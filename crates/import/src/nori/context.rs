//! What is being built, and the files it is built from.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use caustica_scene::description::{Geometry, ImageId, MaterialId, MaterialKind, Mesh};
use caustica_scene::memory::shortage;
use caustica_scene::{Description, Diagnostic, Origin};

use super::tree::Place;
use crate::files::{Folder, Limits, Trust, take};
use crate::image::Codes;
use crate::suggest::shorten;
use crate::{image, obj};

/// The most warnings that are kept: more of them help nobody.
const MOST_WARNINGS: usize = 1000;

fn too_many_triangles(place: Place, trust: Trust, range: &Range<usize>) -> Diagnostic {
    let most = Limits::of(trust).triangles;
    place.error(format!("the scene has more than {most} triangles"), range.clone())
}

/// Warnings, up to a number.
#[derive(Default)]
pub(super) struct Warnings(Vec<Diagnostic>);

impl Warnings {
    pub(super) fn push(&mut self, warning: Diagnostic) {
        if self.0.len() < MOST_WARNINGS {
            self.0.push(warning);
        } else if self.0.len() == MOST_WARNINGS {
            self.0.push(Diagnostic::warning("there are more warnings, which are not shown"));
        }
    }

    pub(super) fn into_vec(self) -> Vec<Diagnostic> {
        self.0
    }
}

/// The bytes of a mesh.
fn mesh_bytes(mesh: &Mesh) -> u64 {
    let corners = size_of_val(&*mesh.positions) + size_of_val(&*mesh.normals) + size_of_val(&*mesh.uvs);
    (corners + size_of_val(&*mesh.triangles)) as u64
}

/// A description that is being filled.
pub(super) struct Context<'c> {
    pub(super) place: Place<'c>,
    pub(super) folder: Folder<'c>,
    pub(super) warnings: &'c mut Warnings,
    pub(super) description: Description,
    /// The shape that first used each mesh file.
    meshes: BTreeMap<PathBuf, usize>,
    images: BTreeMap<PathBuf, ImageId>,
    default_material: Option<MaterialId>,
    /// What may still come.
    left: Limits,
}

impl<'c> Context<'c> {
    pub(super) fn new(place: Place<'c>, folder: Folder<'c>, warnings: &'c mut Warnings) -> Self {
        Self {
            place,
            folder,
            warnings,
            description: Description { samples: 1, ..Description::default() },
            meshes: BTreeMap::new(),
            images: BTreeMap::new(),
            default_material: None,
            left: Limits::of(folder.trust),
        }
    }

    pub(super) fn origin(&self, range: &Range<usize>) -> Option<Origin> {
        Some(self.place.source.origin(range.clone()))
    }

    pub(super) fn warn(&mut self, message: impl Into<String>, range: &Range<usize>) {
        let warning = Diagnostic::warning(message).at(self.origin(range));
        self.warnings.push(warning);
    }

    /// The mesh of a file, for the shape that is added next; `range` is where the file is named.
    pub(super) fn mesh(&mut self, file: &str, range: &Range<usize>) -> Result<Mesh, Diagnostic> {
        let embedded = self.folder.embedded(file);
        let path = match embedded {
            Some(_) => PathBuf::from(file),
            None => self.path("mesh", file, range)?,
        };
        let known = self.meshes.get(&path).map(|shape| &self.description.shapes[*shape].geometry);
        if let Some(Geometry::Mesh(mesh)) = known {
            take(&mut self.left.triangles, mesh.triangles.len())
                .ok_or_else(|| too_many_triangles(self.place, self.folder.trust, range))?;
            let error = |e| shortage(&format!("another copy of the mesh `{file}`"), e);
            let fits = self.folder.memory.check(mesh_bytes(mesh)).map_err(error);
            fits.map_err(|e| self.place_if_unplaced(e, range))?;
            return Ok(mesh.clone());
        }
        let read = match embedded {
            Some(text) => obj::read_obj(text.as_bytes(), file),
            None => obj::load_obj_within(&path, self.folder.memory),
        };
        let read = read.map_err(|e| self.place_if_unplaced(e, range))?;
        read.warnings.into_iter().for_each(|w| self.warnings.push(w));
        take(&mut self.left.triangles, read.mesh.triangles.len())
            .ok_or_else(|| too_many_triangles(self.place, self.folder.trust, range))?;
        self.meshes.insert(path, self.description.shapes.len());
        Ok(read.mesh)
    }

    /// The image of a file; `range` is where it is named.
    pub(super) fn image(&mut self, file: &str, range: &Range<usize>) -> Result<ImageId, Diagnostic> {
        let path = self.path("image", file, range)?;
        if let Some(id) = self.images.get(&path) {
            return Ok(*id);
        }
        let read = image::read_within(&path, (self.left.pixels, Codes::Srgb), self.folder.memory)
            .map_err(|e| self.place_if_unplaced(e, range))?;
        self.left.pixels -= read.image.pixels.len() as u64;
        for warning in read.warnings {
            let placed = self.place_if_unplaced(warning, range);
            self.warnings.push(placed);
        }
        let id = self.description.add_image(read.image);
        self.images.insert(path, id);
        Ok(id)
    }

    /// The path of a mesh or an image.
    fn path(&self, what: &str, file: &str, range: &Range<usize>) -> Result<PathBuf, Diagnostic> {
        self.folder.resolve(file).map_err(|why| {
            let message = format!("cannot read the {what} `{}`: {why}", shorten(file));
            self.place.error(message, range.clone())
        })
    }

    fn place_if_unplaced(&self, diagnostic: Diagnostic, range: &Range<usize>) -> Diagnostic {
        let place = if diagnostic.origin.is_some() { None } else { self.origin(range) };
        diagnostic.at(place)
    }

    /// The material of shapes that name none.
    pub(super) fn default_material(&mut self) -> MaterialId {
        let albedo = caustica_math::Rgb::splat(0.5).into();
        let description = &mut self.description;
        *self
            .default_material
            .get_or_insert_with(|| description.add_material(MaterialKind::Diffuse { albedo }))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use caustica_math::Transform;
    use caustica_scene::MemoryLimit;
    use caustica_scene::description::Shape;

    use super::*;
    use crate::source::Source;

    /// Also of a mesh that is read once and named again.
    #[test]
    fn triangles_are_counted_wherever_they_are_named() {
        let source = Source::new("s.xml", "<scene/>");
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let folder = Folder {
            base: Path::new(""),
            embedded: &[("a", text), ("b", text)],
            memory: MemoryLimit::Machine,
            trust: Trust::OwnFolder,
        };
        for names in [["a", "a", "a"], ["a", "b", "a"], ["a", "a", "b"]] {
            let mut warnings = Warnings::default();
            let mut cx = Context::new(Place { source: &source }, folder, &mut warnings);
            cx.left.triangles = 2;
            for name in &names[..2] {
                let geometry = Geometry::Mesh(cx.mesh(name, &(0..1)).unwrap());
                let (to_world, material) = (Transform::IDENTITY, MaterialId(0));
                let name = String::new();
                let shape = Shape { name, geometry, to_world, material, emission: None, origin: None };
                cx.description.shapes.push(shape);
            }
            let error = cx.mesh(names[2], &(0..1)).unwrap_err();
            assert!(
                error.message.contains("more than 16777216 triangles") && error.origin.is_some(),
                "{error}"
            );
        }
    }
}
