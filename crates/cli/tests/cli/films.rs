//! Films: ranges of samples, merging, checkpoints, and stopping at a noise level.

use caustica::film::{DualFilm, FilmRecord};

use crate::bench::{Bench, Ran};

fn film(bench: &Bench, name: &str) -> FilmRecord {
    FilmRecord::read(&bench.path(name)).unwrap()
}

fn render(bench: &Bench, args: &[&str]) -> Ran {
    bench.run(&[&["render", "scene.xml"], args].concat())
}

#[track_caller]
fn same(a: &DualFilm, b: &DualFilm) {
    assert!(a.bits_equal(b));
}

#[test]
fn films_of_ranges_merge_to_one_in_any_order() {
    let bench = Bench::new();
    render(&bench, &["--spp", "12", "-o", "whole.film"]).ok();
    for (range, name) in [("0..5", "a.film"), ("5..6", "b.film"), ("6..12", "c.film")] {
        let ran = render(&bench, &["--samples", range, "-o", name, "--json"]).ok();
        assert_eq!(ran.json()["outputs"][0], *name);
        assert_eq!(film(&bench, name).facts.samples.to_string(), range);
    }
    let ran = bench.run(&["merge", "c.film", "a.film", "b.film", "-o", "all.film"]).ok();
    assert!(ran.out.starts_with("scene.xml: 12 samples per pixel (0..12) of 3 films, error "), "{}", ran.out);
    same(&film(&bench, "all.film").film, &film(&bench, "whole.film").film);
    bench.run(&["merge", "b.film", "c.film", "-o", "bc.film"]).ok();
    let json = bench.run(&["merge", "a.film", "bc.film", "-o", "a.film", "--json"]).ok().json();
    assert_eq!((&json["samples"], &json["total"]), (&"0..12".into(), &12.into()));
    same(&film(&bench, "a.film").film, &film(&bench, "whole.film").film);

    // Pictures of films are those of renders.
    render(&bench, &["--spp", "12", "-o", "direct"]).ok();
    bench.run(&["develop", "all.film"]).ok();
    assert_eq!(bench.bytes("all.png"), bench.bytes("direct.png"));
    bench.run(&["develop", "all.film", "-o", "all.exr", "--light-image", "off"]).ok();
    let ((ours, facts), (theirs, _)) = (bench.film("all.exr"), bench.film("direct.exr"));
    assert_eq!(ours, theirs);
    assert!(ours.error.is_some());
    assert_eq!((facts.get("scene"), facts.get("integrator")), (Some("scene.xml"), Some("bdpt")));
    let told = bench.run(&["info", "all.film"]).ok().out;
    assert!(told.contains("film of       scene.xml\n") && told.contains("12 per pixel (0..12)"), "{told}");
    assert_eq!(bench.run(&["info", "all.film", "--json"]).ok().json()["provenance"]["scene"], "scene.xml");
}

#[test]
fn films_that_do_not_belong_together_are_refused() {
    let bench = Bench::new();
    render(&bench, &["--samples", "0..3", "-o", "a.film"]).ok();
    render(&bench, &["--samples", "2..4", "-o", "b.film"]).ok();
    render(&bench, &["--samples", "3..4", "--seed", "2", "-o", "seed.film"]).ok();
    render(&bench, &["--samples", "3..4", "--resolution", "25x16", "-o", "size.film"]).ok();
    bench.write_changed("20, 18, 15", "20, 18, 16");
    render(&bench, &["--samples", "3..4", "-o", "lamp.film"]).ok();
    let merge = |other: &str| bench.run(&["merge", "a.film", other, "-o", "out.film"]);
    merge("b.film").fails(3, &["`b.film` cannot be added to `a.film`", "both hold the samples 2..3"]);
    merge("seed.film").fails(3, &["they differ in the seed (0 and 2)", "`--samples`"]);
    merge("size.film").fails(3, &["they are of 24 × 16 pixels in quanta of", "and 25 × 16 pixels"]);
    merge("lamp.film").fails(3, &["they differ in what `scene.xml` holds"]);
    merge("none.film").fails(3, &["`none.film`: there is no such file"]);
    merge("scene.xml").fails(3, &["`scene.xml`: it is not a film file"]);
    bench.run(&["merge", "a.film", "-o", "a.png"]).fails(2, &["must end in .film", "caustica develop"]);
    bench.run(&["merge", "-o", "a.film"]).fails(2, &["FILM"]);
    let bytes = bench.bytes("a.film");
    bench.write("cut.film", &bytes[..bytes.len() - 9]);
    merge("cut.film").fails(3, &["`cut.film`: the film file is cut short or damaged"]);
    bench.run(&["develop", "cut.film"]).fails(3, &["cut short or damaged"]);
    bench.run(&["info", "cut.film"]).fails(3, &["cut short or damaged"]);
    render(&bench, &["--samples", "3..2"]).fails(2, &["such as 1000..2000"]);
    render(&bench, &["--samples", "0..2", "--spp", "2"]).fails(2, &["--spp"]);
    assert!(!bench.made().contains(&"out.film".to_owned()));
}

/// Names and comments may change, what a scene holds may not.
#[test]
fn a_scene_that_only_looks_different_is_the_same() {
    let bench = Bench::new();
    render(&bench, &["--samples", "0..2", "-o", "a.film"]).ok();
    bench.write_changed("<integrator", "<!-- another\n comment -->\n  <integrator");
    std::fs::rename(bench.path("scene.xml"), bench.path("other.xml")).unwrap();
    bench.run(&["render", "other.xml", "--samples", "2..3", "-o", "b.film", "--threads", "1"]).ok();
    bench.run(&["merge", "a.film", "b.film", "-o", "b.film"]).ok();
}

#[test]
fn a_checkpoint_is_continued_and_never_lost_by_mistake() {
    let bench = Bench::new();
    render(&bench, &["--spp", "9", "-o", "whole.film"]).ok();
    render(&bench, &["--spp", "4", "--checkpoint", "c.film", "-o", "p"]).ok();
    assert_eq!(film(&bench, "c.film").facts.samples.to_string(), "0..4");
    render(&bench, &["--spp", "9", "--checkpoint", "c.film", "-o", "p"])
        .fails(4, &["the checkpoint `c.film` is there already", "--resume"]);
    bench.write_changed("20, 18, 15", "20, 18, 16");
    render(&bench, &["--spp", "9", "--checkpoint", "c.film", "--resume"])
        .fails(3, &["what `scene.xml` holds changed"]);
    bench.write("scene.xml", crate::bench::SCENE);
    for (args, words) in [
        (&["--seed", "5", "--spp", "9"][..], "the seed (0 and 5) changed"),
        (&["--resolution", "8x8"], "the film is of 24 × 16 pixels"),
        (&["--spp", "3"], "the film holds 4 samples per pixel already, more than 3"),
        (&["--integrator", "path", "--spp", "9"], "the integrator (bdpt and path) changed"),
        (&["--samples", "3..9"], "holds the samples 0..4, not those from 3 on"),
    ] {
        render(&bench, &[&["--checkpoint", "c.film", "--resume", "-o", "p"], args].concat())
            .fails(3, &[words]);
    }
    let ran = render(&bench, &["--spp", "9", "--checkpoint", "c.film", "--resume", "-o", "p"]).ok();
    assert!(ran.out.starts_with("bdpt: 9 samples per pixel"), "{}", ran.out);
    same(&film(&bench, "c.film").film, &film(&bench, "whole.film").film);
    // There is nothing more to do, but the picture is written again.
    std::fs::remove_file(bench.path("p.png")).unwrap();
    render(&bench, &["--spp", "9", "--checkpoint", "c.film", "--resume", "-o", "p"]).ok();
    assert!(bench.made().contains(&"p.png".to_owned()));
    // The first time there is nothing to resume.
    render(&bench, &["--spp", "2", "--checkpoint", "new.film", "--resume", "-o", "q"]).ok();
    assert_eq!(film(&bench, "new.film").facts.samples.to_string(), "0..2");
    bench.write("bad.film", "no film");
    render(&bench, &["--checkpoint", "bad.film", "--resume"]).fails(3, &["it is not a film file"]);
    render(&bench, &["--checkpoint", "none/c.film"]).fails(4, &["the folder does not exist"]);
    render(&bench, &["--resume"]).fails(2, &["--checkpoint"]);
    render(&bench, &["--checkpoint", "p.png"]).fails(2, &["`p.png` must end in .film"]);
    bench.write("empty.film", "");
    render(&bench, &["--checkpoint", "empty.film", "--resume"]).ok();
    assert_eq!(bench.bytes("bad.film"), b"no film");
}

#[test]
fn rendering_stops_at_a_noise_level() {
    let bench = Bench::new();
    let json = render(&bench, &["--noise", "40%", "-o", "p", "--json"]).ok().json();
    let (samples, noise) = (json["samples"].as_u64().unwrap(), json["noise"].as_f64().unwrap());
    assert!((16..20_000).contains(&samples) && noise <= 0.4, "{json}");
    let (picture, facts) = bench.film("p.exr");
    assert!(picture.error.is_some());
    assert_eq!(facts.get("noise").unwrap().parse::<f64>().unwrap(), (noise * 1e5).round() / 1e5);
    // A limit of samples or time holds all the same.
    let json = render(&bench, &["--noise", "0.000001", "--spp", "20", "--json"]).ok().json();
    assert_eq!(json["samples"], 20);
    let json = render(&bench, &["--noise", "0.000001", "--time", "100ms", "--json"]).ok().json();
    assert!(json["noise"].as_f64().unwrap() > 0.000001);
    let told = render(&bench, &["--spp", "32"]).ok().out;
    assert!(told.contains("error of a typical pixel: "), "{told}");
    render(&bench, &["--noise", "0"]).fails(2, &["positive number"]);
}

/// Killed at any moment, a render leaves a whole checkpoint or none, and the film that is made in the end has the
/// bits of one that was never interrupted.
#[cfg(target_os = "linux")]
#[test]
fn killed_at_random_moments() {
    use std::thread::sleep;
    use std::time::{Duration, Instant};

    let bench = Bench::new();
    let spp = "6000";
    render(&bench, &["--spp", spp, "-o", "whole.film"]).ok();
    let args = ["render", "scene.xml", "--spp", spp, "--checkpoint", "c.film", "--every", "5ms", "--resume"];
    let args = [&args[..], &["-o", "end.film"]].concat();
    let (mut kills, mut held, mut later) = (0u64, 0, 0);
    let start = Instant::now();
    while kills < 60 {
        let mut child = bench.command(&args).spawn().unwrap();
        // Moments between 0 and 250 ms, spread by the golden ratio.
        let moment = (kills as f64 * 0.618_033_988_75).fract() * 0.25;
        sleep(Duration::from_secs_f64(moment));
        if child.try_wait().unwrap().is_some() {
            // All done: begin again.
            same(&film(&bench, "end.film").film, &film(&bench, "whole.film").film);
            std::fs::remove_file(bench.path("c.film")).unwrap();
            held = 0;
            continue;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
        if bench.path("c.film").exists() {
            let kept = film(&bench, "c.film").facts.samples.total();
            assert!(kept >= held, "{kept} after {held}");
            later += u32::from(kept > held);
            held = kept;
        }
        assert!(start.elapsed() < Duration::from_secs(300));
    }
    // Most of them came after something new had been kept.
    assert!(later >= 15, "{later} of {kills}");
    bench.run(&args).ok();
    same(&film(&bench, "end.film").film, &film(&bench, "whole.film").film);
    // What was being written when it was killed is gone too, but for a kill while the output was written.
    assert!(bench.made().iter().all(|n| !n.starts_with(".c.film")), "{:?}", bench.made());
}

/// A disk that is really full, where this user may make one: what was rendered is kept elsewhere.
#[cfg(target_os = "linux")]
#[test]
fn a_film_is_rescued_from_a_full_disk() {
    let bench = Bench::new();
    let program = env!("CARGO_BIN_EXE_caustica");
    let script = format!(
        "mkdir disk; mount -t tmpfs -o size=64k tmpfs disk || exit 77
         {program} render scene.xml --spp 2 --checkpoint disk/c.film -o p -q || exit 1
         head -c 100000 /dev/zero >disk/fill
         TMPDIR=. {program} render scene.xml --spp 9000 --checkpoint disk/c.film --every 10ms --resume -o disk/p
         code=$?; ls -A disk; cp disk/c.film .; exit $code"
    );
    let mut command = std::process::Command::new("unshare");
    let ran = command.current_dir(bench.path("")).args(["-rm", "bash", "-c", &script]).output();
    let Some(ran) = ran.ok().map(Ran::from).filter(|r| r.code == Some(4)) else {
        eprintln!("no file system can be mounted here: full disks are not tested");
        return;
    };
    assert!(ran.err.contains("No space left on device") || ran.err.contains("storage full"), "{}", ran.err);
    assert_eq!(ran.out.split_whitespace().collect::<Vec<_>>(), ["c.film", "fill"]);
    assert_eq!(film(&bench, "c.film").facts.samples.to_string(), "0..2");
    let (_, rest) = ran.err.split_once("the film is saved as `./").unwrap();
    assert_eq!(film(&bench, rest.split_once('`').unwrap().0).facts.samples.to_string(), "0..9000");
}

/// A disk that is full, as far as this program may write: the render goes on and says so, the checkpoint before is
/// kept, and nothing broken is left.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_costs_no_film() {
    let bench = Bench::new();
    render(&bench, &["--spp", "3", "--checkpoint", "c.film", "-o", "p"]).ok();
    let before = bench.bytes("c.film");
    // Files of 1024 bytes at most; the signal that says so is ignored, and writing fails.
    let program = env!("CARGO_BIN_EXE_caustica");
    let line = format!(
        "trap '' XFSZ; ulimit -f 1; exec {program} render scene.xml --spp 9000 --checkpoint c.film --every 10ms \
         --resume -o p"
    );
    let mut command = std::process::Command::new("bash");
    let ran = Ran::from(command.current_dir(bench.path("")).args(["-c", &line]).output().unwrap());
    assert_eq!(ran.code, Some(4), "{ran:?}");
    assert_eq!(ran.err.matches("warning: cannot write `c.film`").count(), 1, "{}", ran.err);
    assert!(ran.err.contains("the render goes on"), "{}", ran.err);
    assert_eq!(bench.bytes("c.film"), before);
    assert_eq!(bench.made(), ["c.film", "p.exr", "p.png"]);
    let resumed = render(&bench, &["--spp", "5", "--checkpoint", "c.film", "--resume", "-o", "p"]).ok();
    assert!(resumed.out.starts_with("bdpt: 5 samples"), "{}", resumed.out);
}

/// Hours of work are not replaced by mistake; what the same command makes again is.
#[test]
fn films_are_not_replaced_if_samples_are_lost() {
    let bench = Bench::new();
    let film = |args: &[&str]| render(&bench, &[args, &["-o", "a.film"]].concat());
    film(&["--samples", "2..6"]).ok();
    film(&["--samples", "2..6"]).ok();
    let before = bench.bytes("a.film");
    film(&["--spp", "4"]).fails(4, &["`a.film` is there and holds the samples 2..6", "`--force`"]);
    film(&["--samples", "2..6", "--seed", "3"]).fails(4, &["they differ in the seed (0 and 3)"]);
    film(&["--samples", "2..6", "--resolution", "20x16"]).fails(4, &["of 24 × 16 pixels", "20 × 16"]);
    bench.write_changed("20, 18, 15", "20, 18, 16");
    film(&["--samples", "2..6"]).fails(4, &["they differ in what `scene.xml` holds"]);
    assert_eq!(bench.bytes("a.film"), before);
    film(&["--samples", "2..6", "--force"]).ok();
    assert_ne!(bench.bytes("a.film"), before);
    // More samples of the same are welcome.
    film(&["--samples", "1..7"]).ok();
    render(&bench, &["--samples", "9..10", "-o", "b.film"]).ok();
    bench.run(&["merge", "b.film", "-o", "a.film"]).fails(4, &["holds the samples 1..7", "`--force`"]);
    bench.run(&["merge", "a.film", "b.film", "-o", "a.film"]).ok();
    bench.write("c.film", "hours of writing");
    render(&bench, &["--spp", "1", "-o", "c.film"])
        .fails(4, &["`c.film` is there and is no film", "`--force`"]);
    bench.run(&["merge", "b.film", "-o", "c.film"]).fails(4, &["is no film"]);
    bench.run(&["merge", "b.film", "-o", "c.film", "--force"]).ok();
}
