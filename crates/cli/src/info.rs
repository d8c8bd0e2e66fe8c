use std::process::ExitCode;

use caustica::Scene;
use caustica::session::info::{SceneInfo, describe, outline};

use crate::args::Info;
use crate::failure::{Failure, show};
use crate::loading;

pub fn run(args: &Info) -> Result<ExitCode, Failure> {
    let (description, mut warnings) = loading::description(args.scene.as_deref())?;
    let outline = outline(&description);
    let (scene, more) = Scene::new(description)?;
    warnings.extend(more);
    let info = describe(&scene, outline, warnings);
    if args.json {
        println!("{}", serde_json::json!(info));
    } else {
        print(&info);
        info.warnings.iter().for_each(show);
    }
    Ok(ExitCode::SUCCESS)
}

fn print(info: &SceneInfo) {
    let list = |counts: &[(&str, usize)]| {
        let items: Vec<String> = counts.iter().map(|(name, n)| format!("{n} {name}")).collect();
        if items.is_empty() { "none".to_owned() } else { items.join(", ") }
    };
    let mib = |bytes: usize| format!("{:.1} MiB", bytes as f64 / (1024.0 * 1024.0));
    let [width, height] = info.resolution;
    println!("picture     {width} × {height}, {} samples per pixel, {}", info.samples, info.integrator);
    println!("camera      {}", info.camera);
    println!("shapes      {} ({} triangles, {} spheres)", info.shapes, info.triangles, info.spheres);
    println!("materials   {}", list(&info.materials));
    println!("lights      {} ({:.4} W in all)", list(&info.lights), info.power);
    match &info.bounds {
        Some([low, high]) => println!("bounds      {low:?} to {high:?}"),
        None => println!("bounds      empty"),
    }
    let m = &info.memory;
    println!(
        "memory      {} (tree {}, surfaces {}, images {}, film {})",
        mib(m.total()),
        mib(m.tree),
        mib(m.surfaces),
        mib(m.images),
        mib(m.film)
    );
}
