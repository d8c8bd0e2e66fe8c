use std::path::PathBuf;
use std::time::Duration;

use caustica::description::{Crop, Integrator, Layer, LayerKind};
use caustica::film::{self, ToneMap};
use caustica::math::Sampler;
use caustica::scene::bvh::TreeQuality;
use caustica::session::{INTEGRATOR_NAMES, MOST_LAYER_SAMPLES};
use caustica::transport::{Heuristic, StrategySet, suited_light_paths};
use caustica::{Scene, Settings};
use caustica_clips::Layout;
use caustica_compare::{DEFAULT_METHODS, EYE_ONLY};
use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::loading::Depths;

/// A bidirectional path tracer for scenes whose light is hard to find.
#[derive(Debug, Parser)]
#[command(name = "caustica", version, after_help = EXIT_CODES)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

const EXIT_CODES: &str = "\
Exit codes:
  0    all went well (also after a first Ctrl-C, which keeps the passes done so far)
  1    a test of `caustica test` failed, or `caustica verify` found a difference
  2    the arguments are wrong
  3    the scene or film file cannot be read, or the scene cannot be rendered
  4    the output cannot be written
  5    the machine cannot do it: not enough memory, or no thread could be started
  130  stopped at once by a second Ctrl-C";

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to an OpenEXR file and a PNG
    Render(Render),
    /// Render a scene by several integrators, and make a page that compares them
    Compare(Compare),
    /// Render what each strategy of bdpt finds, as a pyramid of pictures by path length
    Pyramid(Pyramid),
    /// Make a video (MP4): a render that converges, the strategies of bdpt summed up, or a moving camera
    #[command(subcommand)]
    Video(Video),
    /// Test that all integrators and strategies agree on a scene, as far as each can reach its light
    Verify(Verify),
    /// Tell why a part of a picture is black or noisy: which paths carry its light, and who reaches them
    Explain(Explain),
    /// Add up films of different samples, to the bits of one long render
    Merge(Merge),
    /// Make a picture from a film or a rendered OpenEXR file, with or without its light image
    Develop(Develop),
    /// Tell what a scene file or a film holds
    Info(Info),
    /// Run the statistical tests (`ttest`, `chi2test`) that a scene file carries
    Test(Test),
}

impl Arguments {
    /// How to speak: in JSON, and of nothing but errors.
    pub fn voice(&self) -> Voice {
        match &self.command {
            Command::Render(a) => a.voice,
            Command::Compare(a) => a.voice,
            Command::Merge(a) => a.voice,
            Command::Pyramid(a) => a.voice,
            Command::Video(a) => a.clip().voice,
            Command::Verify(a) => a.voice,
            Command::Explain(a) => a.voice,
            Command::Info(a) => Voice { json: a.json, quiet: false },
            Command::Test(a) => Voice { json: a.json, quiet: false },
            Command::Develop(_) => Voice { json: false, quiet: false },
        }
    }

    /// How many threads may work, if that is said.
    pub fn threads(&self) -> Option<usize> {
        let threads = match &self.command {
            Command::Render(a) => a.source.threads,
            Command::Compare(a) => a.source.threads,
            Command::Pyramid(a) => a.source.threads,
            Command::Video(a) => a.clip().source.threads,
            Command::Verify(a) => a.source.threads,
            Command::Explain(a) => a.source.threads,
            Command::Test(a) => a.threads,
            Command::Info(_) | Command::Merge(_) | Command::Develop(_) => None,
        };
        threads.map(usize::from)
    }
}

/// What is rendered, and on what.
#[derive(Clone, Debug, Args)]
pub struct Source {
    /// Scene file of Nori or Mitsuba; without it, the built-in scene of caustics is rendered
    pub scene: Option<PathBuf>,
    /// Read only files below the scene's own folder: for scenes from people you do not know
    #[arg(long)]
    pub untrusted: bool,
    /// Give a variable of a Mitsuba scene a value; may be repeated
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = parse_definition)]
    pub definitions: Vec<(String, String)>,
    /// Size of the picture, such as 640x480 [default: as the scene says]
    #[arg(long, value_name = "WxH", value_parser = parse_resolution)]
    pub resolution: Option<(u32, u32)>,
    /// Render only this window, in pixels from the upper left
    #[arg(long, value_name = "X,Y,WIDTH,HEIGHT", value_parser = parse_crop)]
    pub crop: Option<Crop>,
    /// Worker threads; the picture does not depend on it [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// How the tree that rays run through is built; the picture does not depend on it
    #[arg(long, value_enum, default_value_t = TreeChoice::Fast)]
    pub tree: TreeChoice,
}

/// For how long to render.
#[derive(Clone, Debug, Args)]
pub struct Length {
    /// Samples per pixel [default: as the scene says, or without limit if --time is given]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// Stop after this long, with the pass that runs: 90, 60s, 5m, 2h
    #[arg(long, value_parser = parse_duration)]
    pub time: Option<Duration>,
}

impl Length {
    /// Samples per pixel at most, where the scene says `usual`.
    pub fn samples(&self, usual: u32) -> u32 {
        self.spp.unwrap_or(if self.time.is_some() { u32::MAX } else { usual })
    }
}

/// The most samples per pixel of `verify` and `explain`: there is a reference with twice as many, rounded up.
const MOST_LOOKED_AT: i64 = 1 << 26;

/// How to speak.
#[derive(Clone, Copy, Debug, Args)]
pub struct Voice {
    /// Say nothing but errors: no progress bar, no warnings, no summary
    #[arg(short, long)]
    pub quiet: bool,
    /// Print the result, warnings or the error as one JSON object on the standard output
    #[arg(long)]
    pub json: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Render {
    #[command(flatten)]
    pub source: Source,
    /// Output files; both OUTPUT.exr and OUTPUT.png are written [default: beside the scene, with its name]. With
    /// OUTPUT.film, only that: a film that can be merged and developed
    #[arg(short, long)]
    pub output: Option<PathBuf>,
    /// Replace a film also if its samples are lost by that
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub length: Length,
    /// Render only these samples of each pixel, of which the second number is not one: 1000..2000 is the second
    /// thousand. Films of other ranges can be added by `caustica merge`
    #[arg(long, value_name = "A..B", conflicts_with = "spp", value_parser = parse_samples)]
    pub samples: Option<(u32, u32)>,
    /// Stop when a typical pixel is right within this part of the brightness around it, with 95 % certainty: 0.01 or 1%.
    /// The number of samples is then 16 at least, and unlimited if --spp does not say otherwise. Light that no sample
    /// has found yet cannot be counted
    #[arg(long, value_name = "ERROR", value_parser = parse_noise)]
    pub noise: Option<f64>,
    #[command(flatten)]
    pub checkpoint: Checkpoint,
    #[command(flatten)]
    pub method: Method,
    /// What becomes of the light image, which holds what light paths splat: most caustics
    #[arg(long, value_name = "CHOICE", value_enum, default_value_t = LightImageChoice::On)]
    pub light_image: LightImageChoice,
    /// Layers of OUTPUT.exr beside the picture, such as albedo,normal,depth [default: as the scene's `aov` integrator says]
    #[arg(long, value_name = "LIST", value_parser = parse_layers, long_help = layers_help())]
    pub layers: Option<LayerList>,
    #[command(flatten)]
    pub look: Look,
    /// Print one sample of the render that the other options ask for, strategy by strategy, instead of rendering
    #[arg(long, value_name = "X,Y,SAMPLE", value_parser = parse_replay)]
    pub replay: Option<([u32; 2], u32)>,
    #[command(flatten)]
    pub voice: Voice,
}

/// Layers beside a picture.
#[derive(Clone, Debug)]
pub struct LayerList(pub Vec<Layer>);

/// How a long render is kept safe.
#[derive(Clone, Debug, Args)]
pub struct Checkpoint {
    /// Keep what is rendered so far in this file, which ends in .film and is replaced whole or not at all
    #[arg(long = "checkpoint", value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// How often: 60s, 10m
    #[arg(long, value_name = "TIME", value_parser = parse_duration, default_value = "60s", requires = "file")]
    pub every: Duration,
    /// Go on where the checkpoint ends, if it is there; --time counts anew
    #[arg(long, requires = "file")]
    pub resume: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Merge {
    /// Films of the same scene and settings, of different samples
    #[arg(required = true, value_name = "FILM")]
    pub films: Vec<PathBuf>,
    /// The film of all their samples
    #[arg(short, long, value_name = "FILM")]
    pub output: PathBuf,
    /// Replace a film also if its samples are lost by that
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub voice: Voice,
}

#[derive(Clone, Debug, Args)]
pub struct Compare {
    #[command(flatten)]
    pub source: Source,
    /// Folder for the page `index.html`, `report.json` and the pictures [default: SCENE-compare beside the scene]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    /// How long each integrator renders: 90, 60s, 5m [default: 30s, unless --spp is given]
    #[arg(long, value_parser = parse_duration, conflicts_with = "spp")]
    pub time: Option<Duration>,
    /// Samples per pixel of each integrator, in place of a time
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// OpenEXR picture of the same size to compare with
    #[arg(long, value_name = "FILE", conflicts_with = "reference_time")]
    pub reference: Option<PathBuf>,
    /// How long to render the reference, by bdpt [default: ten times as long as each integrator]
    #[arg(long, value_name = "TIME", value_parser = parse_duration)]
    pub reference_time: Option<Duration>,
    /// What to compare, of bdpt, bdpt-eye (without its light image), path, path_ems, naive and light
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = method_names(),
        hide_possible_values = true, default_values = DEFAULT_METHODS)]
    pub integrators: Vec<String>,
    #[command(flatten)]
    pub sampling: Sampling,
    #[command(flatten)]
    pub voice: Voice,
}

#[derive(Clone, Debug, Args)]
pub struct Pyramid {
    #[command(flatten)]
    pub source: Source,
    /// Output files: OUTPUT.png, OUTPUT-unweighted.png, OUTPUT.exr and OUTPUT.html are written
    /// [default: SCENE-pyramid beside the scene]
    #[arg(short, long)]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub length: Length,
    /// Rows: the most edges of paths whose strategies are shown. Longer paths are rendered, and added to the whole
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub rows: u32,
    #[command(flatten)]
    pub sampling: Sampling,
    #[command(flatten)]
    pub look: Look,
    #[command(flatten)]
    pub voice: Voice,
}

#[derive(Clone, Debug, Args)]
pub struct Verify {
    #[command(flatten)]
    pub source: Source,
    /// Folder for the page `index.html`, `heat.png` and `report.json` [default: SCENE-verify beside the scene]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    /// Samples per pixel of each estimator; the reference has twice as many
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = clap::value_parser!(u32).range(8..=MOST_LOOKED_AT))]
    pub spp: u32,
    /// Edge of the blocks that are compared, in pixels; larger ones are made of these
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub block: u32,
    /// Probability that any test of the run finds a difference where there is none
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = parse_probability)]
    pub significance: f64,
    #[command(flatten)]
    pub sampling: Sampling,
    #[command(flatten)]
    pub voice: Voice,
}

#[derive(Clone, Debug, Args)]
pub struct Explain {
    #[command(flatten)]
    pub source: Source,
    /// The part of the picture to explain, in pixels from the upper left [default: all of it]. The picture is at most 96
    /// pixels long unless --resolution says otherwise
    #[arg(long, value_name = "X,Y,WIDTH,HEIGHT", value_parser = parse_crop)]
    pub region: Option<Crop>,
    /// The integrator whose picture is to be explained: bdpt, path, path_ems, naive or light
    #[arg(long, value_name = "NAME", default_value = "bdpt", hide_possible_values = true,
        value_parser = ["bdpt", "path", "path_ems", "naive", "light"])]
    pub integrator: String,
    /// Samples per pixel that are looked at
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=MOST_LOOKED_AT))]
    pub spp: u32,
    #[command(flatten)]
    pub sampling: Sampling,
    #[command(flatten)]
    pub voice: Voice,
}

#[derive(Debug, Subcommand)]
pub enum Video {
    /// A render that converges, with and without its light image
    Converge(Converge),
    /// The strategies of bdpt added up one by one: the sum at the left, what is added at the right
    Pyramid(PyramidVideo),
    /// A camera that swings around what it looks at
    Orbit(OrbitVideo),
}

impl Video {
    /// What all kinds have.
    pub fn clip(&self) -> &Clip {
        match self {
            Self::Converge(a) => &a.clip,
            Self::Pyramid(a) => &a.clip,
            Self::Orbit(a) => &a.clip,
        }
    }
}

#[derive(Clone, Debug, Args)]
pub struct Converge {
    #[command(flatten)]
    pub clip: Clip,
    #[command(flatten)]
    pub length: Length,
    /// How the picture with its light image and that without share the frame
    #[arg(long, value_enum, default_value_t = LayoutChoice::Wipe)]
    pub layout: LayoutChoice,
    /// Seconds for which the end is held, after the others
    #[arg(long, default_value_t = 4.0, value_parser = parse_seconds)]
    pub hold: f32,
    #[command(flatten)]
    pub method: Method,
}

#[derive(Clone, Debug, Args)]
pub struct PyramidVideo {
    #[command(flatten)]
    pub clip: Clip,
    /// Samples per pixel [default: as the scene says]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// The most edges of paths whose strategies are added one by one
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub rows: u32,
    /// Seconds for which the end is held, after the others
    #[arg(long, default_value_t = 3.0, value_parser = parse_seconds)]
    pub hold: f32,
    #[command(flatten)]
    pub sampling: Sampling,
}

#[derive(Clone, Debug, Args)]
pub struct OrbitVideo {
    #[command(flatten)]
    pub clip: Clip,
    /// Samples per pixel of every frame
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: u32,
    /// The whole angle: 360 goes round, less swings there and back
    #[arg(long, default_value_t = 30.0, allow_negative_numbers = true, value_parser = parse_degrees)]
    pub degrees: f64,
    /// The point to go around [default: what the middle of the picture shows]
    #[arg(long, value_name = "X,Y,Z", allow_negative_numbers = true, value_parser = parse_point)]
    pub centre: Option<[f32; 3]>,
    #[command(flatten)]
    pub method: Method,
}

/// What all videos have.
#[derive(Clone, Debug, Args)]
pub struct Clip {
    #[command(flatten)]
    pub source: Source,
    /// The file, which ends in .mp4 [default: SCENE-KIND.mp4 beside the scene]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Length in seconds
    #[arg(long, default_value_t = 10.0, value_parser = parse_seconds)]
    pub seconds: f32,
    /// Frames per second
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=60))]
    pub fps: u32,
    /// From 0, the smallest file, to 100, the best picture
    #[arg(long, value_name = "N", default_value_t = 80, value_parser = clap::value_parser!(u8).range(0..=100))]
    pub quality: u8,
    #[command(flatten)]
    pub look: Look,
    #[command(flatten)]
    pub voice: Voice,
}

/// How light is found.
#[derive(Clone, Debug, Args)]
pub struct Method {
    /// Integrator
    #[arg(long, value_name = "NAME", value_parser = integrator_names(), hide_possible_values = true,
        help = integrator_names_help(), long_help = integrator_help())]
    pub integrator: Option<String>,
    /// Strategies (s, t) of bdpt, with s light and t camera vertices: `s=0`, `t>=2`, `2,3`, `s>=2&t>=2`,
    /// `s=0;s=1`, `all`. What is left stays unbiased where it reaches
    #[arg(long, value_name = "SET", default_value = "all")]
    pub strategies: StrategySet,
    #[command(flatten)]
    pub sampling: Sampling,
}

/// How paths are sampled and weighed.
#[derive(Clone, Debug, Args)]
pub struct Sampling {
    /// Most edges of a path: 1 is lamps seen directly, 2 adds direct light [default: no limit]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub max_depth: Option<u32>,
    /// Bounces before Russian roulette begins [default: 1 for bdpt and light, 5 for the others]
    #[arg(long, value_name = "N")]
    pub roulette_depth: Option<u32>,
    /// Seed of the sample streams
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// How samples are chosen
    #[arg(long, value_enum, default_value_t = SamplerChoice::Sobol)]
    pub sampler: SamplerChoice,
    /// Rays of bdpt that are aimed at mirrors and glass from each point from where nothing else makes a path, to find
    /// the light behind them
    #[arg(long, value_name = "N", default_value_t = Settings::default().aimed_rays,
        value_parser = clap::value_parser!(u32).range(0..=i64::from(Settings::MOST_AIMED_RAYS)))]
    pub aimed_rays: u32,
    /// Light paths that bdpt joins each eye path with: its own and those of pixels some way off (1, 2, 4, 8 or 16). More cost
    /// more time a sample, and pay where most light is indirect [default: 1 to 8, as a first look at the scene advises]
    #[arg(long, value_name = "N", value_parser = parse_shared)]
    pub shared_light_paths: Option<u32>,
    /// How the strategies of bdpt are weighed
    #[arg(long, value_enum, default_value_t = HeuristicChoice::Balance)]
    pub heuristic: HeuristicChoice,
}

impl Sampling {
    /// The same with what the scene asks for where nothing else is said.
    #[must_use]
    pub fn or(&self, depths: Depths) -> Self {
        Self {
            max_depth: self.max_depth.or(depths.max_depth),
            roulette_depth: self.roulette_depth.or(depths.roulette_start),
            ..*self
        }
    }

    /// The same with as many shared light paths as suit the scene where nothing else is said.
    #[must_use]
    pub fn suited(&self, scene: &Scene) -> Self {
        let suited = || suited_light_paths(scene, &self.settings(Integrator::Bdpt));
        Self { shared_light_paths: Some(self.shared_light_paths.unwrap_or_else(suited)), ..*self }
    }

    /// The settings of an integrator that is sampled so, with all strategies.
    pub fn settings(&self, integrator: Integrator) -> Settings {
        Settings {
            integrator,
            max_depth: self.max_depth,
            roulette_start: self.roulette_depth,
            seed: self.seed,
            sampler: self.sampler.into(),
            heuristic: self.heuristic.into(),
            aimed_rays: self.aimed_rays,
            shared_light_paths: self.shared_light_paths.unwrap_or(Settings::default().shared_light_paths),
            ..Settings::default()
        }
    }

    /// The same for people, and the program's version.
    pub fn notes(&self) -> Vec<(String, String)> {
        let name = |value: clap::builder::PossibleValue| value.get_name().to_owned();
        let depth = self.max_depth.map_or_else(|| "unlimited".to_owned(), |d| d.to_string());
        let roulette = self.roulette_depth.map_or_else(|| "as usual".to_owned(), |d| d.to_string());
        [
            ("max depth", depth),
            ("roulette depth", roulette),
            ("aimed rays", self.aimed_rays.to_string()),
            (
                "shared light paths",
                self.shared_light_paths.map_or_else(|| "as usual".to_owned(), |n| n.to_string()),
            ),
            ("seed", self.seed.to_string()),
            ("sampler", self.sampler.to_possible_value().map(name).unwrap_or_default()),
            ("heuristic", self.heuristic.to_possible_value().map(name).unwrap_or_default()),
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ]
        .map(|(name, value)| (name.to_owned(), value))
        .into()
    }
}

/// How a picture is shown.
#[derive(Clone, Copy, Debug, Args)]
pub struct Look {
    /// Exposure in stops; 1 is twice as bright
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_exposure)]
    pub exposure: f32,
    /// Tone map: srgb (clipped) or agx (filmic)
    #[arg(long, value_name = "NAME", default_value_t = ToneMap::Srgb)]
    pub tone_map: ToneMap,
}

impl Look {
    /// The same for the library.
    pub fn develop(self) -> film::Develop {
        film::Develop { exposure: self.exposure, tone_map: self.tone_map }
    }
}

#[derive(Clone, Debug, Args)]
pub struct Develop {
    /// Film, or OpenEXR file with an eye and a light image, as `caustica render` writes them
    pub film: PathBuf,
    /// Output file: .png, or .exr to keep all layers with another `combined` [default: FILM.png]
    #[arg(short, long)]
    pub output: Option<PathBuf>,
    /// What becomes of the light image
    #[arg(long, value_name = "CHOICE", value_enum, default_value_t = LightImageChoice::On)]
    pub light_image: LightImageChoice,
    #[command(flatten)]
    pub look: Look,
}

#[derive(Clone, Debug, Args)]
pub struct Info {
    /// Scene file of Nori or Mitsuba, or film; without it, the built-in scene
    pub scene: Option<PathBuf>,
    /// Read only files below the scene's own folder: for scenes from people you do not know
    #[arg(long)]
    pub untrusted: bool,
    /// Give a variable of a Mitsuba scene a value; may be repeated
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = parse_definition)]
    pub definitions: Vec<(String, String)>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Clone, Debug, Args)]
pub struct Test {
    /// Nori scene file with tests
    pub scene: PathBuf,
    /// Read only files below the scene's own folder: for scenes from people you do not know
    #[arg(long)]
    pub untrusted: bool,
    /// Seed of the sample streams
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Worker threads; the outcome does not depend on it [default: all]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// What becomes of the light image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LightImageChoice {
    /// Added to the eye image
    On,
    /// Left out
    Off,
    /// Shown alone
    Only,
    /// Asked at the end
    Ask,
}

/// How the picture with its light image and that without share a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LayoutChoice {
    /// A line sweeps over the picture
    Wipe,
    /// One, then the other
    Toggle,
    /// Side by side
    Side,
    /// With the light image alone
    With,
    /// Without it alone
    Without,
}

impl From<LayoutChoice> for Layout {
    fn from(choice: LayoutChoice) -> Self {
        match choice {
            LayoutChoice::Wipe => Self::Wipe,
            LayoutChoice::Toggle => Self::Toggle,
            LayoutChoice::Side => Self::Side,
            LayoutChoice::With => Self::With,
            LayoutChoice::Without => Self::Without,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TreeChoice {
    /// At once
    Fast,
    /// With large triangles cut up: several times slower to build, faster to render where long triangles lie
    /// across the axes
    Spatial,
}

impl From<TreeChoice> for TreeQuality {
    fn from(choice: TreeChoice) -> Self {
        match choice {
            TreeChoice::Fast => Self::Fast,
            TreeChoice::Spatial => Self::Spatial,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SamplerChoice {
    /// Owen-scrambled Sobol' points, well spread over a pixel's samples and over neighbouring pixels
    Sobol,
    /// Each by itself: noisier, to compare with
    Independent,
}

impl From<SamplerChoice> for Sampler {
    fn from(choice: SamplerChoice) -> Self {
        match choice {
            SamplerChoice::Sobol => Self::Sobol,
            SamplerChoice::Independent => Self::Independent,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum HeuristicChoice {
    /// By density
    Balance,
    /// By density squared
    Power,
}

impl From<HeuristicChoice> for Heuristic {
    fn from(choice: HeuristicChoice) -> Self {
        match choice {
            HeuristicChoice::Balance => Self::Balance,
            HeuristicChoice::Power => Self::Power,
        }
    }
}

/// Other names that scene files use are accepted too.
const INTEGRATOR_ALIASES: [&str; 3] = ["path_mis", "path_mats", "direct_mis"];

fn integrator_names() -> clap::builder::PossibleValuesParser {
    let names = INTEGRATOR_NAMES.iter().map(|(name, _)| *name).chain(INTEGRATOR_ALIASES);
    clap::builder::PossibleValuesParser::new(names.collect::<Vec<_>>())
}

fn method_names() -> clap::builder::PossibleValuesParser {
    clap::builder::PossibleValuesParser::new(["bdpt", EYE_ONLY, "path", "path_ems", "naive", "light"])
}

fn integrator_names_help() -> String {
    let names: Vec<&str> = INTEGRATOR_NAMES.iter().map(|(name, _)| *name).collect();
    format!("Integrator: {} [default: as the scene says]", names.join(", "))
}

fn integrator_help() -> String {
    let mut help = "Integrator [default: as the scene says]".to_owned();
    for (name, what) in INTEGRATOR_NAMES {
        help.push_str(&format!("\n  {name:<12} {what}"));
    }
    help
}

fn layers_help() -> String {
    let kinds: Vec<&str> = LayerKind::ALL.iter().map(|kind| kind.name()).collect();
    format!(
        "Layers of OUTPUT.exr beside the picture, of what is seen first: KIND or NAME:KIND, between commas; `none` for \
         none [default: those that the scene's `aov` integrator lists]\n\
         Kinds: normal (sh_normal), {}\n\
         They are means by the pixel filter over the first {MOST_LAYER_SAMPLES} samples of each pixel, whose rays are \
         traced again after the render; indices are those of the sample next to the pixel's centre. Where nothing is \
         seen they are zero. Denoisers ask for `albedo,normal`",
        kinds.join(", ")
    )
}

fn parse_layers(text: &str) -> Result<LayerList, String> {
    if text.trim() == "none" {
        return Ok(LayerList(Vec::new()));
    }
    let layers = text.split(',').map(|entry| entry.trim().parse()).collect::<Result<Vec<_>, _>>()?;
    Layer::check_all(&layers)?;
    Ok(LayerList(layers))
}

fn parse_duration(text: &str) -> Result<Duration, String> {
    let unit_start = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (number, unit) = text.split_at(unit_start);
    let factor = match unit {
        "" | "s" => 1.0,
        "ms" => 1e-3,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return Err("use a number with ms, s, m or h, such as 90s or 5m".into()),
    };
    let seconds = number.trim().parse::<f64>().ok().map(|n| n * factor);
    match seconds {
        Some(s) if s > 0.0 && s < 1e9 => Ok(Duration::from_secs_f64(s)),
        _ => Err("use a positive number with ms, s, m or h, such as 90s or 5m".into()),
    }
}

/// The longest side of a picture; what is larger is a typing error.
const LONGEST_SIDE: u32 = 65_536;

fn parse_resolution(text: &str) -> Result<(u32, u32), String> {
    let side = |t: &str| t.trim().parse().ok().filter(|n| (1..=LONGEST_SIDE).contains(n));
    text.split_once(['x', 'X', '×'])
        .and_then(|(w, h)| Some((side(w)?, side(h)?)))
        .ok_or_else(|| format!("use WIDTHxHEIGHT with sides from 1 to {LONGEST_SIDE}, such as 640x480"))
}

fn numbers<const N: usize>(text: &str) -> Option<[u32; N]> {
    let parts: Vec<u32> = text.split(',').map(|p| p.trim().parse().ok()).collect::<Option<_>>()?;
    parts.try_into().ok()
}

fn parse_definition(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
        _ => Err("use NAME=VALUE, such as spp=64".into()),
    }
}

fn parse_crop(text: &str) -> Result<Crop, String> {
    match numbers(text) {
        Some([x, y, width, height]) if width > 0 && height > 0 => Ok(Crop { x, y, width, height }),
        _ => Err("use X,Y,WIDTH,HEIGHT in pixels, such as 100,50,64,64".into()),
    }
}

fn parse_samples(text: &str) -> Result<(u32, u32), String> {
    let ranges: film::SampleRanges = text.parse().map_err(|e: film::FilmError| e.to_string())?;
    let numbers = ranges.single().map(|r| (u32::try_from(r.start), u32::try_from(r.end)));
    match numbers {
        Some((Ok(start), Ok(end))) => Ok((start, end)),
        _ => Err(format!("samples have numbers up to {}", u32::MAX)),
    }
}

fn parse_noise(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let error = match text.strip_suffix('%') {
        Some(percent) => percent.trim().parse::<f64>().map(|p| p / 100.0),
        None => text.parse(),
    };
    match error {
        Ok(e) if e > 0.0 && e < 10.0 => Ok(e),
        _ => Err("use a positive number below 10, such as 0.01, or 1%".into()),
    }
}

fn parse_replay(text: &str) -> Result<([u32; 2], u32), String> {
    match numbers(text) {
        Some([x, y, sample]) => Ok(([x, y], sample)),
        None => Err("use X,Y,SAMPLE, such as 320,240,0".into()),
    }
}

fn parse_seconds(text: &str) -> Result<f32, String> {
    match text.trim().trim_end_matches('s').parse::<f32>() {
        Ok(s) if (0.0..=3600.0).contains(&s) => Ok(s),
        _ => Err("use a number of seconds from 0 to 3600".into()),
    }
}

fn parse_probability(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(p) if p > 0.0 && p < 1.0 => Ok(p),
        _ => Err("use a number between 0 and 1, such as 0.01".into()),
    }
}

fn parse_degrees(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(degrees) if degrees.abs() <= 36_000.0 => Ok(degrees),
        _ => Err("use a number of degrees between -36000 and 36000".into()),
    }
}

fn parse_point(text: &str) -> Result<[f32; 3], String> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|p| p.trim().parse().ok()).collect();
    match numbers.and_then(|n| <[f32; 3]>::try_from(n).ok()) {
        Some(point) if point.iter().all(|c| c.is_finite()) => Ok(point),
        _ => Err("use X,Y,Z, such as 0,1.5,-2".into()),
    }
}

fn parse_exposure(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(stops) if stops.abs() <= 100.0 => Ok(stops),
        _ => Err("use a number of stops between -100 and 100".into()),
    }
}

fn parse_shared(text: &str) -> Result<u32, String> {
    const MOST: u32 = Settings::MOST_SHARED_LIGHT_PATHS;
    match text.parse::<u32>() {
        Ok(paths) if paths.is_power_of_two() && paths <= MOST => Ok(paths),
        _ => Err(format!("use 1, 2, 4, 8 or {MOST}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn durations_have_units() {
        assert_eq!(parse_duration("90"), Ok(Duration::from_secs(90)));
        assert_eq!(parse_duration("1.5m"), Ok(Duration::from_secs(90)));
        assert_eq!(parse_duration("250ms"), Ok(Duration::from_millis(250)));
        assert!(parse_duration("0s").is_err() && parse_duration("-1").is_err());
        assert!(parse_duration("5 parsecs").is_err() && parse_duration("nan").is_err());
    }

    #[test]
    fn sizes_and_windows() {
        assert_eq!(parse_resolution("640x480"), Ok((640, 480)));
        assert!(parse_resolution("640").is_err() && parse_resolution("0x5").is_err());
        assert!(parse_resolution("99999999x99999999").is_err());
        assert_eq!(parse_crop("1,2,3,4"), Ok(Crop { x: 1, y: 2, width: 3, height: 4 }));
        assert!(parse_crop("1,2,0,4").is_err() && parse_crop("1,2,3").is_err());
    }

    #[test]
    fn ranges_of_samples_and_errors() {
        assert_eq!(parse_samples("5..7"), Ok((5, 7)));
        assert!(parse_samples("7..5").is_err() && parse_samples("0..4294967296").is_err());
        assert_eq!((parse_noise("0.01"), parse_noise("2 %")), (Ok(0.01), Ok(0.02)));
        assert!(parse_noise("0").is_err() && parse_noise("-1").is_err() && parse_noise("nan").is_err());
    }
}
