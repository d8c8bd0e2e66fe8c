use crate::bench::Bench;

/// The layer `combined` in the eyes of a program that knows nothing of the others: the PNG.
fn png(bench: &Bench, args: &[&str]) -> Vec<u8> {
    bench.run(&[&["render", "scene.xml", "-o", "x", "--spp", "8"], args].concat()).ok();
    bench.bytes("x.png")
}

#[test]
fn the_light_image_is_added_left_out_or_shown_alone() {
    let bench = Bench::new();
    let [on, off, only] = ["on", "off", "only"].map(|choice| {
        let file = png(&bench, &["--light-image", choice]);
        let (picture, facts) = bench.film("x.exr");
        assert_eq!(facts.get("lightImage"), Some(choice));
        (file, picture)
    });
    assert!(on.0 != off.0 && on.0 != only.0 && off.0 != only.0);
    assert!(on.1 == off.1 && on.1 == only.1, "both layers stay in the file");
    assert!(on.1.light.iter().any(|p| p.max_channel() > 0.0));
    assert_eq!(png(&bench, &[]), on.0, "on is the default");
}

#[test]
fn answers_choose_and_silence_means_yes() {
    let bench = Bench::new();
    let [on, off, only] = ["on", "off", "only"].map(|c| png(&bench, &["--light-image", c]));
    let args = ["render", "scene.xml", "-o", "asked", "--spp", "8", "--light-image", "ask"];
    for (input, expected, choice) in [
        ("y\n", &on, "on"),
        ("\n", &on, "on"),
        ("", &on, "on"),
        ("n\n", &off, "off"),
        ("NO", &off, "off"),
        ("only\n", &only, "only"),
        ("perhaps\nn\n", &off, "off"),
    ] {
        let ran = bench.run_with_input(&args, input).ok();
        assert!(ran.err.starts_with("Add the light image"), "{}", ran.err);
        assert_eq!(ran.err.matches("[Y/n/only]").count(), 1 + usize::from(input.contains("perhaps")));
        assert_eq!(&bench.bytes("asked.png"), expected, "{input:?}");
        assert_eq!(bench.film("asked.exr").1.get("lightImage"), Some(choice), "{input:?}");
    }
}

#[test]
fn nobody_is_asked_about_a_light_image_that_is_not_there() {
    let bench = Bench::new();
    let args = ["render", "scene.xml", "--integrator", "path", "--light-image"];
    assert_eq!(bench.run_with_input(&[&args[..], &["ask"]].concat(), "n\n").ok().err, "");
    let ran = bench.run(&[&args[..], &["only"]].concat()).ok();
    assert!(ran.err.contains("`path` makes no light image here: the picture will be black"), "{}", ran.err);
    let ran = bench.run(&["render", "scene.xml", "--integrator", "light", "--light-image", "off"]).ok();
    assert!(ran.err.contains("`light` makes no eye image here"), "{}", ran.err);
}

#[test]
fn exposure_and_tone_map_change_the_png_alone() {
    let bench = Bench::new();
    let plain = png(&bench, &[]);
    let (picture, _) = bench.film("x.exr");
    let mut seen = vec![plain];
    for look in [&["--exposure", "-2"][..], &["--exposure=1.5"], &["--tone-map", "agx"]] {
        let changed = png(&bench, look);
        assert!(!seen.contains(&changed), "{look:?}");
        seen.push(changed);
        assert_eq!(bench.film("x.exr").0, picture);
    }
}
