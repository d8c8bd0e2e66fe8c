//! Ctrl-C, by the signal that it sends.
#![cfg(target_os = "linux")]

use std::process::{Child, Command};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::bench::{Bench, Ran};

const PATIENCE: Duration = Duration::from_secs(20);

/// Sends the signal that Ctrl-C sends.
fn interrupt(child: &Child) {
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

/// Whether a process has a handler for that signal.
fn listens(child: &Child) -> bool {
    let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
    let caught = status.lines().find_map(|l| l.strip_prefix("SigCgt:")).unwrap();
    u64::from_str_radix(caught.trim(), 16).unwrap() & 2 != 0
}

/// Starts a render that would take days, and returns once it listens to Ctrl-C.
fn start(bench: &Bench, more: &[&str]) -> Child {
    start_any(bench, &[&["render", "scene.xml", "--spp", "4000000000", "--threads", "1"], more].concat())
}

/// The same for any work.
fn start_any(bench: &Bench, args: &[&str]) -> Child {
    let child = bench.command(args).spawn().unwrap();
    let started = Instant::now();
    while !listens(&child) {
        assert!(started.elapsed() < PATIENCE);
        sleep(Duration::from_millis(10));
    }
    // Long enough for the first pass to begin.
    sleep(Duration::from_millis(300));
    child
}

#[test]
fn the_first_one_ends_with_the_pass_and_keeps_what_is_there() {
    let bench = Bench::new();
    let child = start(&bench, &["--json"]);
    interrupt(&child);
    let ran = Ran::from(child.wait_with_output().unwrap()).ok();
    let result = ran.json();
    let (picture, facts) = bench.film("scene.exr");
    assert_eq!(result["stopped"], true);
    let samples = result["samples"].as_u64().unwrap();
    assert!((1..4_000_000_000).contains(&samples));
    assert_eq!((picture.eye_samples, picture.light_samples), (samples, samples));
    assert_eq!(facts.get("samples"), Some(samples.to_string().as_str()));
    // All that is in the film was counted: the same number of samples gives the same picture.
    if samples < 5000 {
        let (whole, _) = bench.render("whole", &["--spp", &samples.to_string()]);
        assert_eq!(picture, whole);
    }
    assert!(bench.bytes("scene.png").starts_with(b"\x89PNG"));
}

#[test]
fn people_are_told_and_asked() {
    let bench = Bench::new();
    let child = start(&bench, &["--light-image", "ask"]);
    interrupt(&child);
    let ran = Ran::from(child.wait_with_output().unwrap()).ok();
    assert!(ran.err.starts_with("stopping after this pass; Ctrl-C again stops at once"), "{}", ran.err);
    assert!(ran.err.contains("[Y/n/only]"), "{}", ran.err);
    assert!(
        ran.out.contains(", stopped early\n") && ran.out.ends_with("\nwrote scene.exr and scene.png\n"),
        "{}",
        ran.out
    );
}

#[test]
fn the_second_one_ends_at_once() {
    let bench = Bench::new();
    // A pass of this takes minutes.
    let child = start(&bench, &["--quiet", "--resolution", "4000x4000"]);
    interrupt(&child);
    sleep(Duration::from_millis(200));
    let before = Instant::now();
    interrupt(&child);
    let ran = Ran::from(child.wait_with_output().unwrap());
    assert!(before.elapsed() < Duration::from_secs(3));
    assert_eq!(ran.code, Some(130), "{ran:?}");
    assert!(bench.made().is_empty());
}

#[test]
fn comparisons_pyramids_and_videos_keep_what_there_is() {
    let bench = Bench::new();
    for (args, made) in [
        (
            &["compare", "scene.xml", "--time", "90s", "--reference-time", "50ms"][..],
            "scene-compare/index.html",
        ),
        (&["pyramid", "scene.xml", "--spp", "4000000000"], "scene-pyramid.html"),
        (&["video", "converge", "scene.xml", "--spp", "4000000000"], "scene-converge.mp4"),
        (&["video", "orbit", "scene.xml", "--spp", "2", "--seconds", "3600"], "scene-orbit.mp4"),
    ] {
        let child = start_any(&bench, args);
        interrupt(&child);
        let ran = Ran::from(child.wait_with_output().unwrap()).ok();
        assert!(ran.err.contains("stopping after this pass"), "{args:?}: {}", ran.err);
        assert!(!bench.bytes(made).is_empty());
    }
    let json = String::from_utf8(bench.bytes("scene-compare/report.json")).unwrap();
    assert!(json.contains("stopped early"), "{json}");
}
