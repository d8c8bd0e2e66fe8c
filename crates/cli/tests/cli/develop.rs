use crate::bench::{Bench, Ran};

fn develop(bench: &Bench, args: &[&str]) -> Ran {
    bench.run(&[&["develop", "film.exr"], args].concat())
}

#[test]
fn a_film_can_be_developed_as_it_was_rendered() {
    let bench = Bench::new();
    for look in [
        &["--light-image", "on"][..],
        &["--light-image", "off"],
        &["--light-image", "only"],
        &["--exposure", "-1.5", "--tone-map", "agx"],
        &["--tone-map", "srgb", "--exposure", "2"],
    ] {
        bench.run(&[&["render", "scene.xml", "-o", "film"], look].concat()).ok();
        let rendered = bench.bytes("film.png");
        let ran = develop(&bench, look).ok();
        assert_eq!((ran.out.as_str(), ran.err.as_str()), ("wrote film.png\n", ""));
        assert_eq!(bench.bytes("film.png"), rendered, "{look:?}");
        assert!(develop(&bench, &[look, &["-o", "b.PNG"]].concat()).ok().out.contains("b.PNG"));
        assert_eq!(bench.bytes("b.PNG"), rendered, "{look:?}");
    }
}

#[test]
fn a_film_developed_to_a_film_keeps_its_layers_and_facts() {
    let bench = Bench::new();
    let (picture, facts) = bench.render("film", &["--seed", "3"]);
    develop(&bench, &["--light-image", "off", "-o", "off.exr"]).ok();
    bench.render("same", &["--seed", "3", "--light-image", "off"]);
    let (developed, its_facts) = bench.film("off.exr");
    assert_eq!(developed, picture);
    assert_eq!(its_facts.get("lightImage"), Some("off"));
    for (name, value) in facts.iter().filter(|(name, _)| *name != "lightImage") {
        assert_eq!(its_facts.get(name), Some(value));
    }
    let answered =
        bench.run_with_input(&["develop", "film.exr", "-o", "n.exr", "--light-image", "ask"], "n\n");
    assert!(answered.ok().err.contains("[Y/n/only]"));
    assert_eq!(bench.bytes("n.exr"), bench.bytes("off.exr"));
}

#[test]
fn what_cannot_be_developed_is_told() {
    let bench = Bench::new();
    bench.render("film", &[]);
    let film = bench.bytes("film.exr");
    develop(&bench, &["-o", "a.jpg"]).fails(2, &["`a.jpg` must end in .png or .exr"]);
    develop(&bench, &["-o", "a"]).fails(2, &["must end in"]);
    develop(&bench, &["-o", "none/a.png"]).fails(4, &["`none/a.png`: the folder does not exist"]);
    bench.run(&["develop", "none.exr"]).fails(3, &["`none.exr`: there is no such file"]);
    bench.run(&["develop", "."]).fails(3, &["`.`"]);
    bench.run(&["develop", "film.png"]).fails(3, &["`film.png`", "not an OpenEXR file"]);
    for length in [0, 3, 40, film.len() / 2, film.len() - 1] {
        bench.write("cut.exr", &film[..length]);
        bench.run(&["develop", "cut.exr"]).fails(3, &["`cut.exr`"]);
    }
    // The same file with a layer of another name.
    let mut other = film.clone();
    let at = film.windows(5).position(|w| w == b"eye.B").unwrap();
    other[at..at + 3].copy_from_slice(b"eyf");
    bench.write("other.exr", other);
    bench.run(&["develop", "other.exr"]).fails(3, &["has no layer `eye`"]);
    assert_eq!(bench.made(), ["cut.exr", "film.exr", "film.png", "other.exr"]);
}
