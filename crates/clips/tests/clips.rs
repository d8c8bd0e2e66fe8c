//! Clips from start to end, small.

use caustica_clips::{
    ClipError, ClipOptions, Converge, Layout, Orbit, PyramidClip, Step, converge, orbit, pyramid,
};
use caustica_film::Develop;
use caustica_render::{Control, RenderOptions};
use caustica_scene::{Description, Scene};
use caustica_testkit::agreement::flatten;
use caustica_testkit::scenes::open_box;
use caustica_transport::Settings;
use tempfile::TempDir;

struct Bench {
    folder: TempDir,
    description: Description,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap(), description: open_box() }
    }

    fn scene(&self) -> Scene {
        flatten(self.description.clone())
    }

    fn options(&self, seconds: f32) -> ClipOptions {
        ClipOptions {
            path: self.folder.path().join("clip.mp4"),
            title: "box".into(),
            frames_per_second: 10,
            seconds,
            quality: 50,
            develop: Develop::default(),
        }
    }

    /// The bytes of the file, if there is one.
    fn bytes(&self) -> Option<Vec<u8>> {
        std::fs::read(self.folder.path().join("clip.mp4")).ok()
    }

    fn files(&self) -> usize {
        std::fs::read_dir(self.folder.path()).unwrap().count()
    }
}

fn render(samples: u32) -> RenderOptions {
    let settings = Settings { max_depth: Some(5), ..Settings::default() };
    RenderOptions { settings, samples, threads: Some(2), ..RenderOptions::default() }
}

#[test]
fn converging_clips_hold_the_end() {
    let bench = Bench::new();
    let scene = bench.scene();
    let size = [scene.film.width, scene.film.height];
    for layout in [Layout::Wipe, Layout::Toggle, Layout::Side, Layout::With, Layout::Without] {
        let what = Converge { render: render(8), layout, hold: 0.5 };
        let mut steps = Vec::new();
        let made =
            converge(&scene, &what, &bench.options(1.2), &Control::default(), |s| steps.push(s)).unwrap();
        assert_eq!((made.frames, steps.len()), (17, 17), "{layout:?}");
        assert_eq!(steps[16], Step { done: 17, total: 17 });
        let width = if layout == Layout::Side { 2 * size[0] } else { size[0] };
        assert_eq!((made.width, made.height), (width.next_multiple_of(2), size[1].next_multiple_of(2)));
        assert!(bench.bytes().unwrap().len() > 1000);
    }
}

/// By samples, the same clip every time but for the time in its captions; so without captions' help, by the picture
/// alone: with and without the light image differ.
#[test]
fn the_light_image_is_seen() {
    let bench = Bench::new();
    let scene = bench.scene();
    let bytes = [Layout::With, Layout::Without].map(|layout| {
        let what = Converge { render: render(4), layout, hold: 0.0 };
        converge(&scene, &what, &bench.options(0.5), &Control::default(), |_| ()).unwrap();
        bench.bytes().unwrap()
    });
    assert_ne!(bytes[0], bytes[1]);
}

#[test]
fn pyramids_have_a_step_for_each_strategy() {
    let bench = Bench::new();
    let scene = bench.scene();
    let what = PyramidClip { render: render(4), rows: 3, hold: 0.2 };
    let control = Control::default();
    // 2 + 3 + 4 strategies and the longer paths, three frames each, and two that hold the end.
    let made = pyramid(&scene, &what, (&bench.options(3.0), &control), |_| (), |_| ()).unwrap();
    assert_eq!(made.frames, 32);
    assert_eq!(made.width, 2 * scene.film.width);
}

#[test]
fn orbits_leave_the_camera_where_it_was() {
    let bench = Bench::new();
    let mut scene = bench.scene();
    let before = (scene.camera.position(), scene.camera.forward());
    let what = Orbit { render: render(1), degrees: 20.0, centre: None };
    let camera = &bench.description.camera;
    let made = orbit(&mut scene, (camera, &what), &bench.options(0.6), &Control::default(), |_| ()).unwrap();
    assert_eq!(made.frames, 6);
    assert_eq!((scene.camera.position(), scene.camera.forward()), before);
}

#[test]
fn stopping_keeps_the_frames_that_there_are() {
    let bench = Bench::new();
    let mut scene = bench.scene();
    let control = Control::default();
    let stop_at = |n: u32| {
        move |s: Step, control: &Control| {
            if s.done == n {
                control.stop()
            }
        }
    };
    let what = Converge { render: render(64), layout: Layout::Wipe, hold: 0.5 };
    let made = converge(&scene, &what, &bench.options(2.0), &control, |s| stop_at(3)(s, &control)).unwrap();
    // The end is held as ever.
    assert_eq!(made.frames, 3 + 5);
    let what = Orbit { render: render(1), degrees: 360.0, centre: None };
    let again = Control::default();
    let camera = &bench.description.camera;
    let options = bench.options(2.0);
    let made = orbit(&mut scene, (camera, &what), &options, &again, |s| stop_at(2)(s, &again)).unwrap();
    assert_eq!((made.frames, bench.files()), (2, 1));
}

#[test]
fn stopping_at_once_leaves_no_file() {
    let bench = Bench::new();
    let control = Control::default();
    control.stop();
    let what = Converge { render: render(64), layout: Layout::Wipe, hold: 0.0 };
    let stopped = converge(&bench.scene(), &what, &bench.options(2.0), &control, |_| ());
    assert!(matches!(stopped, Err(ClipError::Stopped)), "{stopped:?}");
    assert_eq!(bench.files(), 0);
}
