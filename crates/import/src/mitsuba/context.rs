//! What is being built, and the files it is built from.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use caustica_math::Rgb;
use caustica_scene::description::{GroupId, ImageId, Layer, Material, MaterialId, MaterialKind, Mesh};
use caustica_scene::memory::shortage;
use caustica_scene::{Description, Diagnostic, Origin};

use super::paths::Paths;
use super::tree::{Tree, Value};
use crate::files::{Limits, take};
use crate::image::Codes;
use crate::{image, obj, ply, serialized};

/// The most warnings that are kept: more of them help nobody.
const MOST_WARNINGS: usize = 1000;

/// A description that is being filled.
pub(super) struct Context<'c> {
    pub(super) tree: &'c Tree,
    paths: Paths<'c>,
    warnings: Vec<Diagnostic>,
    pub(super) description: Description,
    /// The most edges of a path, if the scene says so.
    pub(super) max_depth: Option<u32>,
    /// The bounces before roulette, if the scene says so.
    pub(super) roulette_start: Option<u32>,
    /// What is to be written beside the picture.
    pub(super) layers: Vec<Layer>,
    /// Whether the camera does not see lamps.
    pub(super) hides_lamps: bool,
    /// Sensors in shapes: the place of each in the tree, and of its shape in the description.
    pub(super) meters: Vec<(usize, u32)>,
    /// Those that are named again.
    meshes: BTreeMap<(PathBuf, Format), Mesh>,
    /// How often each file name stands in the scene.
    named: BTreeMap<&'c str, u32>,
    images: BTreeMap<(PathBuf, Codes), ImageId>,
    /// The materials of objects of the tree.
    pub(super) materials: BTreeMap<usize, MaterialId>,
    /// The groups of objects of the tree, if they have shapes.
    pub(super) groups: BTreeMap<usize, Option<GroupId>>,
    /// Of shapes that are no lamps, and of lamps.
    default_materials: [Option<MaterialId>; 2],
    /// What may still come.
    left: Limits,
    /// Bytes of the meshes that were made and not read.
    made: u64,
}

impl<'c> Context<'c> {
    pub(super) fn new(tree: &'c Tree, paths: Paths<'c>, warnings: Vec<Diagnostic>) -> Self {
        let left = Limits::of(paths.folder.trust);
        Self {
            tree,
            paths,
            warnings,
            description: Description { samples: 4, ..Description::default() },
            max_depth: None,
            roulette_start: None,
            layers: Vec::new(),
            hides_lamps: false,
            meters: Vec::new(),
            meshes: BTreeMap::new(),
            named: file_names(tree),
            images: BTreeMap::new(),
            materials: BTreeMap::new(),
            groups: BTreeMap::new(),
            default_materials: [None; 2],
            left,
            made: 0,
        }
    }

    pub(super) fn push(&mut self, warning: Diagnostic) {
        if self.warnings.len() < MOST_WARNINGS {
            self.warnings.push(warning);
        } else if self.warnings.len() == MOST_WARNINGS {
            self.warnings.push(Diagnostic::warning("there are more warnings, which are not shown"));
        }
    }

    /// The description and the warnings.
    pub(super) fn finish(self) -> (Description, Vec<Diagnostic>) {
        (self.description, self.warnings)
    }

    /// Where a file is that is named at `origin`.
    fn path(&self, what: &str, file: &str, origin: &Origin) -> Result<PathBuf, Diagnostic> {
        self.paths.find(file).map_err(|why| {
            let file = crate::suggest::shorten(file);
            super::tree::error(format!("cannot read the {what} `{file}`: {why}"), origin)
        })
    }

    /// The mesh of a file that is named at `origin`.
    pub(super) fn mesh(&mut self, file: &str, format: Format, origin: &Origin) -> Result<Mesh, Diagnostic> {
        let path = match self.paths.folder.embedded(file) {
            Some(_) => PathBuf::from(file),
            None => self.path("mesh", file, origin)?,
        };
        let placed = |e: Diagnostic| if e.origin.is_some() { e } else { e.at(Some(origin.clone())) };
        let mesh = if let Some(mesh) = self.meshes.get(&(path.clone(), format)) {
            let bytes = bytes_of(mesh);
            let error = |e| placed(shortage(&format!("another copy of the mesh `{file}`"), e));
            self.paths.folder.memory.check(bytes).map_err(error)?;
            mesh.clone()
        } else {
            let (mesh, warnings) = self.read_mesh(file, &path, format).map_err(placed)?;
            warnings.into_iter().for_each(|w| self.push(w));
            if self.named.get(file).is_some_and(|times| *times > 1) {
                self.meshes.insert((path, format), mesh.clone());
            }
            mesh
        };
        self.take_triangles(&mesh, origin)?;
        Ok(mesh)
    }

    /// Counts a mesh that is made for a shape described at `origin`, and not read from a file: a few bytes of XML ask
    /// for it.
    pub(super) fn count_made(&mut self, mesh: &Mesh, origin: &Origin) -> Result<(), Diagnostic> {
        self.made += bytes_of(mesh);
        let error = |e| shortage("the scene's meshes", e).at(Some(origin.clone()));
        self.paths.folder.memory.check(self.made).map_err(error)?;
        self.take_triangles(mesh, origin)
    }

    fn take_triangles(&mut self, mesh: &Mesh, origin: &Origin) -> Result<(), Diagnostic> {
        let most = Limits::of(self.paths.folder.trust).triangles;
        take(&mut self.left.triangles, mesh.triangles.len())
            .ok_or_else(|| super::tree::error(format!("the scene has more than {most} triangles"), origin))
    }

    fn read_mesh(
        &self,
        file: &str,
        path: &Path,
        format: Format,
    ) -> Result<(Mesh, Vec<Diagnostic>), Diagnostic> {
        let memory = self.paths.folder.memory;
        match (self.paths.folder.embedded(file), format) {
            (Some(text), _) => obj::read_obj(text.as_bytes(), file).map(|read| (read.mesh, read.warnings)),
            (None, Format::Obj) => obj::load_obj_within(path, memory).map(|read| (read.mesh, read.warnings)),
            (None, Format::Ply) => ply::load(path, memory).map(|read| (read.mesh, read.warnings)),
            (None, Format::Serialized(index)) => {
                serialized::load(path, index, memory).map(|mesh| (mesh, Vec::new()))
            }
        }
    }

    /// The image of a file that is named at `origin`.
    pub(super) fn image(&mut self, file: &str, origin: &Origin) -> Result<ImageId, Diagnostic> {
        self.image_of(file, Codes::Srgb, origin)
    }

    /// The same, told what its codes are.
    pub(super) fn image_of(
        &mut self,
        file: &str,
        codes: Codes,
        origin: &Origin,
    ) -> Result<ImageId, Diagnostic> {
        let key = (self.path("image", file, origin)?, codes);
        if let Some(id) = self.images.get(&key) {
            return Ok(*id);
        }
        let placed = |e: Diagnostic| if e.origin.is_some() { e } else { e.at(Some(origin.clone())) };
        let read = image::read_within(&key.0, (self.left.pixels, codes), self.paths.folder.memory)
            .map_err(placed)?;
        self.left.pixels -= read.image.pixels.len() as u64;
        read.warnings.into_iter().for_each(|w| self.push(placed(w)));
        let id = self.description.add_image(read.image);
        self.images.insert(key, id);
        Ok(id)
    }

    /// Adds a material that is described at `origin`.
    pub(super) fn add_material(&mut self, kind: MaterialKind, origin: &Origin) -> MaterialId {
        let id = MaterialId(self.description.materials.len() as u32);
        self.description.materials.push(Material { kind, origin: Some(origin.clone()) });
        id
    }

    /// The material of shapes that name none: grey, but lamps are black.
    pub(super) fn default_material(&mut self, is_lamp: bool) -> MaterialId {
        let albedo = Rgb::splat(if is_lamp { 0.0 } else { 0.5 }).into();
        let description = &mut self.description;
        *self.default_materials[usize::from(is_lamp)]
            .get_or_insert_with(|| description.add_material(MaterialKind::Diffuse { albedo }))
    }
}

/// How often each file name stands in the scene: what is named once need not be kept to be copied. (Shapes may be read
/// more often, where a group or a scene refers to them again; they are read from the file again then.)
fn file_names(tree: &Tree) -> BTreeMap<&str, u32> {
    let mut names = BTreeMap::new();
    for property in tree.objects.iter().flat_map(|o| &o.properties) {
        if let ("filename", Value::String(name)) = (property.name.as_str(), &property.value) {
            *names.entry(name.as_str()).or_insert(0) += 1;
        }
    }
    names
}

/// Formats of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Format {
    Obj,
    Ply,
    /// With the number of the mesh in the file.
    Serialized(u32),
}

/// How many bytes a mesh takes.
fn bytes_of(mesh: &Mesh) -> u64 {
    let attributes: usize = mesh.attributes.iter().map(|a| size_of_val(&*a.values)).sum();
    let corners = size_of_val(&*mesh.positions) + size_of_val(&*mesh.normals) + size_of_val(&*mesh.uvs);
    (corners + size_of_val(&*mesh.triangles) + attributes) as u64
}
