//! Both pages with made-up images: `cargo run -p caustica-report --example sample_report -- FOLDER`, then open
//! `FOLDER/index.html` and `FOLDER/pyramid.html`.

mod pictures;

use std::error::Error;
use std::path::PathBuf;

use caustica_report::{write_comparison, write_pyramid};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "sample-report".to_owned()));
    write_comparison(&pictures::comparison(800, 600), &folder)?;
    write_pyramid(&pictures::pyramid(320, 240), &folder.join("pyramid.html"))?;
    println!("{}", folder.join("index.html").display());
    Ok(())
}
