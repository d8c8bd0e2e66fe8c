use std::path::{Path, PathBuf};

use caustica::description::{Camera, Integrator, Layer};
use caustica::import::{self, Provision, Trust};
use caustica::scene::Diagnostic;
use caustica::scene::bvh::TreeQuality;
use caustica::{Description, Scene, default_scene};

use crate::args::Source;
use crate::console::Console;
use crate::failure::Failure;

/// What `--untrusted` says.
pub fn trust(untrusted: bool) -> Trust {
    if untrusted { Trust::OwnFolder } else { Trust::Full }
}

/// How long paths are, as a scene asks for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Depths {
    /// Most edges of a path.
    pub max_depth: Option<u32>,
    /// Bounces before roulette.
    pub roulette_start: Option<u32>,
}

/// What a scene file holds, or the program itself.
pub struct Read {
    pub description: Description,
    pub depths: Depths,
    /// What it wants written beside the picture.
    pub layers: Vec<Layer>,
}

/// The scene of that file, or the built-in one.
pub fn description(
    path: Option<&Path>,
    provision: &Provision<'_>,
    console: &mut Console,
) -> Result<Read, Failure> {
    let Some(path) = path else {
        return match provision.variables {
            [] => {
                let (description, depths) = (default_scene::description(), Depths::default());
                Ok(Read { description, depths, layers: Vec::new() })
            }
            _ => Err(Failure::Usage("the built-in scene has no variables".into())),
        };
    };
    let loaded = import::load_with(path, provision)?;
    console.warn(loaded.warnings);
    let depths = Depths { max_depth: loaded.max_depth, roulette_start: loaded.roulette_start };
    let description = loaded.scene.ok_or_else(|| {
        Diagnostic::error(format!("`{}` carries tests but no scene", path.display()))
            .hint("run it with `caustica test`")
    })?;
    Ok(Read { description, depths, layers: loaded.layers })
}

/// The description made ready.
pub fn scene(description: Description, tree: TreeQuality, console: &mut Console) -> Result<Scene, Failure> {
    let (scene, warnings) = Scene::with_tree(description, tree)?;
    console.warn(warnings);
    Ok(scene)
}

/// A scene that is ready to be rendered.
pub struct Opened {
    pub scene: Scene,
    /// The integrator that its file asks for.
    pub integrator: Integrator,
    /// Samples per pixel that it asks for.
    pub samples: u32,
    /// How long paths are that it asks for.
    pub depths: Depths,
    /// Its camera.
    pub camera: Camera,
    /// What it wants written beside the picture.
    pub layers: Vec<Layer>,
}

/// Loads what is to be rendered.
pub fn open(source: &Source, console: &mut Console) -> Result<Opened, Failure> {
    open_with(source, console, |_| ()).map(|(opened, ())| opened)
}

/// The same, with a look at the description as it is rendered.
pub fn open_with<T>(
    source: &Source,
    console: &mut Console,
    look: impl FnOnce(&mut Description) -> T,
) -> Result<(Opened, T), Failure> {
    let read = description(source.scene.as_deref(), &source.provision(), console)?;
    let Read { mut description, depths, layers } = read;
    override_film(&mut description, source, console)?;
    let seen = look(&mut description);
    let (integrator, samples) = (description.integrator, description.samples.max(1));
    let camera = description.camera.clone();
    let scene = scene(description, source.tree.into(), console)?;
    Ok((Opened { scene, integrator, samples, depths, camera, layers }, seen))
}

/// Loads a scene to be looked into, its picture made smaller if a longest side is given; and the names of its shapes.
pub fn open_shrunk(
    source: &Source,
    side: Option<u32>,
    console: &mut Console,
) -> Result<(Scene, Vec<String>, Depths), Failure> {
    let Read { mut description, depths, .. } =
        description(source.scene.as_deref(), &source.provision(), console)?;
    override_film(&mut description, source, console)?;
    if let Some(side) = side {
        caustica_verify::shrink(&mut description.film, side);
    }
    let names = description.all_shapes().map(|s| s.name.clone()).collect();
    Ok((scene(description, source.tree.into(), console)?, names, depths))
}

/// `--resolution` and `--crop`.
fn override_film(d: &mut Description, source: &Source, console: &mut Console) -> Result<(), Failure> {
    let film = &mut d.film;
    if let Some((width, height)) = source.resolution {
        (film.width, film.height) = (width, height);
        if film.crop.take().is_some() && source.crop.is_none() {
            console
                .warn([Diagnostic::warning("the scene's crop window does not count at another resolution")
                    .hint("choose one by `--crop`")]);
        }
    }
    if let Some(crop) = source.crop {
        let fits = |start: u32, size: u32, full: u32| start.checked_add(size).is_some_and(|end| end <= full);
        if !fits(crop.x, crop.width, film.width) || !fits(crop.y, crop.height, film.height) {
            return Err(Failure::Usage(format!(
                "the crop window reaches beyond the picture of {} × {} pixels",
                film.width, film.height
            )));
        }
        film.crop = Some(crop);
    }
    Ok(())
}

impl Source {
    /// What its scene may read, and is given.
    pub fn provision(&self) -> Provision<'_> {
        Provision { trust: trust(self.untrusted), variables: &self.definitions }
    }

    /// The scene file's name, for people.
    pub fn name(&self) -> String {
        let name = self.scene.as_deref().and_then(Path::file_name);
        name.map_or_else(|| "built-in".to_owned(), |n| n.to_string_lossy().into_owned())
    }

    /// Where to write what is made of the scene if nobody says: beside it, its name with an ending.
    pub fn beside(&self, ending: &str) -> PathBuf {
        let stem = self.scene.as_deref().map_or_else(|| PathBuf::from("caustica"), |s| s.with_extension(""));
        let mut name = stem.into_os_string();
        name.push(ending);
        name.into()
    }
}
