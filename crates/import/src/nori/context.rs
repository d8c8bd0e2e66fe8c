//! What is being built, and the files it is built from.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use caustica_scene::description::{Geometry, ImageId, MaterialId, MaterialKind, Mesh};
use caustica_scene::memory::shortage;
use caustica_scene::{Description, Diagnostic, Origin};

use super::tree::Place;
use crate::files::Folder;
use crate::{image, obj};

/// The most warnings that are kept: more of them help nobody.
const MOST_WARNINGS: usize = 1000;

/// The most triangles of a scene. A mesh that is named many times is there many times, so that a short
/// file could fill any memory.
const MOST_TRIANGLES: usize = 1 << 28;

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
    triangles: usize,
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
            triangles: 0,
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
        let path = self.folder.base.join(file);
        let known = self.meshes.get(&path).map(|shape| &self.description.shapes[*shape].geometry);
        let mesh = if let Some(Geometry::Mesh(mesh)) = known {
            let bytes = mesh_bytes(mesh);
            let error = |e| shortage(&format!("another copy of the mesh `{file}`"), e);
            self.folder.memory.check(bytes).map_err(error).map_err(|e| self.place_if_unplaced(e, range))?;
            mesh.clone()
        } else {
            let read = match self.folder.embedded(file) {
                Some(text) => obj::read_obj(text.as_bytes(), file),
                None => obj::load_obj_within(&path, self.folder.memory),
            };
            let read = read.map_err(|e| self.place_if_unplaced(e, range))?;
            read.warnings.into_iter().for_each(|w| self.warnings.push(w));
            self.meshes.insert(path, self.description.shapes.len());
            read.mesh
        };
        self.triangles += mesh.triangles.len();
        if self.triangles > MOST_TRIANGLES {
            let message = format!("the scene has more than {MOST_TRIANGLES} triangles");
            return Err(self.place.error(message, range.clone()));
        }
        Ok(mesh)
    }

    /// The image of a file; `range` is where it is named.
    pub(super) fn image(&mut self, file: &str, range: &Range<usize>) -> Result<ImageId, Diagnostic> {
        let path = self.folder.base.join(file);
        if let Some(id) = self.images.get(&path) {
            return Ok(*id);
        }
        let read = image::read_image_within(&path, self.folder.memory)
            .map_err(|e| self.place_if_unplaced(e, range))?;
        for warning in read.warnings {
            let placed = self.place_if_unplaced(warning, range);
            self.warnings.push(placed);
        }
        let id = self.description.add_image(read.image);
        self.images.insert(path, id);
        Ok(id)
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
