//! Made-up images for both pages.

use caustica_math::Rgb;
use caustica_math::elementary::{cos, pow};
use caustica_report::{
    Comparison, CurvePoint, Entry, Inset, Metrics, Pyramid, Shown, Speedup, StrategyImages,
};

/// Five noisy images of hills and what they should look like.
pub fn comparison(width: u32, height: u32) -> Comparison {
    let size = [width.div_ceil(4), height.div_ceil(4)];
    let truth = picture(width, height, |_, colour| colour);
    let methods = [
        ("naive", "emission found by chance", 1.6, 300.0),
        ("path", "next-event estimation", 0.5, 400.0),
        ("light", "paths from the lamps", 0.35, 350.0),
        ("eye", "bdpt without the light image", 0.2, 190.0),
        ("bdpt", "all strategies", 0.08, 180.0),
    ];
    let entries = methods.map(|(name, label, noise, samples)| {
        let noisy = picture(width, height, |seed, colour| grain(seed, noise, colour));
        entry(Shown { name: name.into(), width, height, pixels: noisy }, label, &truth, samples)
    });
    let note = |name: &str, value: &str| (name.to_owned(), value.to_owned());
    Comparison {
        title: "Five ways to light a hill".into(),
        scene: "A made-up picture, to try the page".into(),
        notes: vec![
            note("Resolution", &format!("{width} × {height}")),
            note("Time each", "30 s"),
            note("Threads", "8"),
        ],
        speedups: vec![
            speedup("bdpt", "path", 14.3),
            speedup("bdpt", "naive", 210.0),
            speedup("eye", "path", 3.4),
        ],
        reference: Some(Shown { name: "reference".into(), width, height, pixels: truth }),
        entries: entries.into(),
        insets: vec![
            Inset {
                label: "The sun".into(),
                x: 3 * width / 8,
                y: height / 7,
                width: size[0],
                height: size[1],
            },
            Inset { label: "A ridge".into(), x: width / 6, y: height / 2, width: size[0], height: size[1] },
        ],
    }
}

fn speedup(faster: &str, slower: &str, factor: f64) -> Speedup {
    Speedup { faster: faster.into(), slower: slower.into(), factor, at_least: false }
}

/// An entry with simple errors, and a curve that falls as those of unbiased methods do.
fn entry(shown: Shown, label: &str, truth: &[Rgb], samples: f64) -> Entry {
    let relative = |(a, b): (&Rgb, &Rgb)| {
        let part = |c: usize| f64::from(a.0[c] - b.0[c]) / (f64::from(b.0[c]) + 0.01);
        (0..3).map(|c| part(c) * part(c)).sum::<f64>() / 3.0
    };
    let errors: Vec<f64> = shown.pixels.iter().zip(truth).map(relative).collect();
    let rel_mse = errors.iter().sum::<f64>() / errors.len() as f64;
    let point = |k: i32| {
        let part = 0.5_f64.powi(9 - k);
        let rel_mse = rel_mse / part * (1.0 + 0.15 * (f64::from(k * 7 % 5) - 2.0) * part.sqrt());
        CurvePoint { seconds: 30.0 * part, samples: samples * part, rel_mse, trimmed_rel_mse: 0.6 * rel_mse }
    };
    let sum: f64 = shown.pixels.iter().map(|p| p.0.iter().sum::<f32>() as f64 / 3.0).sum();
    let flip_map: Vec<f32> = errors.iter().map(|e| (e.sqrt() * 0.4).min(1.0) as f32).collect();
    let metrics = Metrics {
        rel_mse: Some(rel_mse),
        trimmed_rel_mse: Some(0.6 * rel_mse),
        rmse: Some(0.2 * rel_mse.sqrt()),
        flip: Some(flip_map.iter().sum::<f32>() as f64 / errors.len() as f64),
        mean: sum / errors.len() as f64,
        samples,
        seconds: 30.0,
        efficiency: Some(1.0 / (rel_mse * 30.0)),
    };
    let curve = (0..=9).map(point).collect();
    Entry { shown, label: label.into(), metrics, flip_map: Some(flip_map), curve, slope: Some(-0.99) }
}

/// What twenty strategies see of the hills.
pub fn pyramid(width: u32, height: u32) -> Pyramid {
    let mut strategies = Vec::new();
    for length in 1..=5_u32 {
        for s in 0..=length {
            let share = 1.0 / ((length + 1) as f32 * pow(1.7, length as f32));
            let lit = |seed: u32, colour: Rgb| {
                let part = (u64::from(seed) % u64::from(width * height)) as f32 / (width * height) as f32;
                colour * (share * (1.0 + cos(6.0 * (part + s as f32 / length as f32))))
            };
            let weighted = picture(width, height, |seed, colour| grain(seed + s, 0.1, lit(seed, colour)));
            let unweighted =
                weighted.iter().enumerate().map(|(i, c)| grain(i as u32, 0.9, *c * 3.0)).collect();
            strategies.push(StrategyImages { s, t: length + 1 - s, weighted, unweighted });
        }
    }
    let notes = vec![("Scene".to_owned(), "made up".to_owned()), ("Depth".to_owned(), "5".to_owned())];
    Pyramid { title: "Strategies of a hill".into(), width, height, strategies, rest: Vec::new(), notes }
}

/// A sun over hills; `change` gets the pixel's number and colour.
fn picture(width: u32, height: u32, change: impl Fn(u32, Rgb) -> Rgb) -> Vec<Rgb> {
    let colour = |i: u32| {
        let (x, y) = ((i % width) as f32 / width as f32, (i / width) as f32 / height as f32);
        change(i, hills(x, y))
    };
    (0..width * height).map(colour).collect()
}

fn hills(x: f32, y: f32) -> Rgb {
    let sun = (x - 0.5) * (x - 0.5) + (y - 0.26) * (y - 0.26) * 0.6;
    if sun < 0.0045 {
        return Rgb::new(14.0, 9.0, 4.5);
    }
    for ridge in (0..5).rev() {
        let k = ridge as f32;
        let top = 0.45 + 0.12 * k + 0.05 * cos(x * (9.0 - k) + 2.1 * k) + 0.015 * cos(x * 31.0 + k);
        if y > top {
            let far = 1.0 / (1.0 + k);
            return Rgb::new(0.05 + 0.42 * far, 0.06 + 0.3 * far, 0.1 + 0.24 * far) * (1.15 - y * 0.5);
        }
    }
    let glow = 0.035 / (sun + 0.03);
    Rgb::new(0.35 + glow, 0.36 + 0.6 * glow, 0.55 + 0.2 * glow)
}

/// Noise that keeps the mean: a gamma-like factor from a hash of the pixel.
fn grain(seed: u32, amount: f32, colour: Rgb) -> Rgb {
    let hash = |salt: u32| {
        let mut h = (seed ^ salt.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b);
        h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
        ((h ^ (h >> 16)) >> 8) as f32 / (1 << 24) as f32
    };
    let uneven = hash(1) * hash(2) * 4.0 - 1.0;
    let tint = |salt| 1.0 + amount * uneven + 0.06 * amount * (hash(salt) - 0.5);
    Rgb::new(colour.0[0] * tint(3).max(0.0), colour.0[1] * tint(4).max(0.0), colour.0[2] * tint(5).max(0.0))
}
