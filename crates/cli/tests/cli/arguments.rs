use crate::bench::Bench;

#[test]
fn wrong_arguments_exit_with_2_and_write_nothing() {
    let bench = Bench::new();
    for (args, words) in [
        (&["--spp", "0"][..], "0 is not in 1.."),
        (&["--spp", "-3"], "unexpected argument '-3'"),
        (&["--spp", "many"], "invalid"),
        (&["--time", "soon"], "90s or 5m"),
        (&["--time", "0s"], "positive"),
        (&["--integrator", "bdtp"], "similar value exists: 'bdpt'"),
        (&["--max-depth", "0"], "0 is not in 1.."),
        (&["--resolution", "640"], "WIDTHxHEIGHT"),
        (&["--resolution", "0x480"], "from 1 to 65536"),
        (&["--resolution", "70000x1"], "from 1 to 65536"),
        (&["--crop", "1,2,3"], "X,Y,WIDTH,HEIGHT"),
        (&["--crop", "0,0,0,1"], "X,Y,WIDTH,HEIGHT"),
        (&["--seed", "x"], "invalid"),
        (&["--shared-light-paths", "0"], "1, 2, 4, 8 or 16"),
        (&["--shared-light-paths", "3"], "1, 2, 4, 8 or 16"),
        (&["--shared-light-paths", "32"], "1, 2, 4, 8 or 16"),
        (&["--threads", "0"], "0 is not in 1.."),
        (&["--tree", "tall"], "fast, spatial"),
        (&["--light-image", "maybe"], "on, off, only, ask"),
        (&["--strategies", "s=="], "no set of strategies"),
        (&["--strategies", "0"], "no set of strategies"),
        (&["--exposure", "nan"], "stops"),
        (&["--tone-map", "reinhard"], "srgb or agx"),
        (&["--replay", "1,2"], "X,Y,SAMPLE"),
        (&["--bogus"], "unexpected argument '--bogus'"),
    ] {
        bench.run(&[&["render", "scene.xml"], args].concat()).fails(2, &[words]);
    }
    assert!(bench.made().is_empty());
}

#[test]
fn wrong_arguments_are_told_in_json_too() {
    let bench = Bench::new();
    let ran = bench.run(&["render", "--json", "--spp", "0"]);
    assert_eq!(ran.code, Some(2));
    let json = ran.json();
    assert_eq!(json["exit_code"], 2);
    let message = json["error"]["message"].as_str().unwrap();
    assert!(message.starts_with("invalid value '0' for '--spp <N>'"), "{message}");
}

#[test]
fn help_tells_exit_codes_and_defaults() {
    let bench = Bench::new();
    let help = bench.run(&["--help"]).ok().out;
    for word in ["render", "develop", "info", "test", "Exit codes:", "130  stopped at once"] {
        assert!(help.contains(word), "{word}: {help}");
    }
    let help = bench.run(&["render", "--help"]).ok().out;
    for word in [
        "bdpt         bidirectional",
        "[default: all]",
        "[default: 1 for bdpt and light, 5 for the others]",
        "[default: on]",
        "60s, 5m",
    ] {
        assert!(help.contains(word), "{word}: {help}");
    }
    assert!(bench.run(&["--version"]).ok().out.starts_with("caustica "));
    assert_eq!(bench.run(&[]).code, Some(2));
}
