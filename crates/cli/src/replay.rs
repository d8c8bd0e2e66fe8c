use std::process::ExitCode;

use caustica::session::replay::{Replay, replay};
use caustica::{Scene, Settings};

use crate::failure::Failure;

pub fn run(
    scene: &Scene,
    settings: Settings,
    (pixel, sample): ([u32; 2], u32),
    json: bool,
) -> Result<ExitCode, Failure> {
    if pixel[0] >= scene.film.width || pixel[1] >= scene.film.height {
        return Err(Failure::Usage(format!(
            "pixel {},{} is not in the picture of {}x{} pixels",
            pixel[0], pixel[1], scene.film.width, scene.film.height
        )));
    }
    let record = replay(scene, settings, pixel, sample);
    if json {
        println!("{}", serde_json::json!(record));
    } else {
        print(&record);
    }
    Ok(ExitCode::SUCCESS)
}

fn print(r: &Replay) {
    println!("pixel {},{} sample {}: eye image {:?}", r.pixel[0], r.pixel[1], r.sample, r.eye);
    for splat in &r.splats {
        println!("splat at {:.2},{:.2}: {:?}", splat.film[0], splat.film[1], splat.value);
    }
    for c in &r.contributions {
        println!("\n({}, {})  contribution {:?}  weight {:.6}", c.s, c.t, c.contribution, c.weight);
        for v in &c.path {
            let place = if v.infinite { "towards" } else { "at" };
            let [x, y, z] = v.at;
            print!("    {:<6} {place} {x:.5} {y:.5} {z:.5}", v.kind);
            if let (Some(forward), Some(reverse)) = (v.pdf_forward, v.pdf_reverse) {
                print!("  pdf {forward:.4e} forward, {reverse:.4e} reverse");
            }
            println!("{}", if v.delta { "  Dirac" } else { "" });
        }
    }
}
