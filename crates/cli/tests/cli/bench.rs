//! A folder with a tiny scene, and running the program in it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use caustica::film::{Metadata, Picture, read_exr};
use serde_json::Value;
use tempfile::TempDir;

/// A glass ball and a lamp above a floor, in 24 × 16 pixels.
pub const SCENE: &str = r#"<scene>
  <integrator type="bdpt"/>
  <camera type="perspective">
    <transform name="toWorld"><lookat origin="0, 1, -4" target="0, 0.4, 0" up="0, 1, 0"/></transform>
    <float name="fov" value="40"/>
    <integer name="width" value="24"/>
    <integer name="height" value="16"/>
    <rfilter type="box"/>
  </camera>
  <sampler type="independent"><integer name="sampleCount" value="2"/></sampler>
  <mesh type="obj"><string name="filename" value="floor.obj"/></mesh>
  <mesh type="sphere">
    <point name="center" value="0, 0.6, 0"/><float name="radius" value="0.5"/>
    <bsdf type="dielectric"/>
  </mesh>
  <mesh type="sphere">
    <point name="center" value="0.8, 1.2, 0"/><float name="radius" value="0.2"/>
    <emitter type="area"><color name="radiance" value="20, 18, 15"/></emitter>
  </mesh>
</scene>
"#;

/// A square in the plane y = 0 that faces up.
pub const FLOOR: &str = "v -3 0 -3\nv -3 0 3\nv 3 0 3\nv 3 0 -3\nf 1 2 3 4\n";

/// A folder that is gone after the test.
pub struct Bench(TempDir);

/// What a run of the program came to.
#[derive(Debug)]
pub struct Ran {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Bench {
    /// A folder with `scene.xml` and its mesh.
    pub fn new() -> Self {
        let bench = Self(tempfile::tempdir().unwrap());
        bench.write("scene.xml", SCENE);
        bench.write("floor.obj", FLOOR);
        bench
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), text).unwrap();
    }

    /// Writes `scene.xml` with a part of it replaced.
    pub fn write_changed(&self, from: &str, to: &str) {
        assert!(SCENE.contains(from), "{from}");
        self.write("scene.xml", SCENE.replacen(from, to, 1));
    }

    /// The names of all files but those that the bench wrote.
    pub fn made(&self) -> Vec<String> {
        let names = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> = names.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.retain(|n| n != "scene.xml" && n != "floor.obj");
        names.sort();
        names
    }

    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_caustica"));
        command.current_dir(self.0.path()).args(args).stdin(Stdio::null());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    pub fn run(&self, args: &[&str]) -> Ran {
        self.command(args).output().unwrap().into()
    }

    /// Runs the program with these words on its standard input.
    pub fn run_with_input(&self, args: &[&str], input: &str) -> Ran {
        self.write("stdin", input);
        let stdin = std::fs::File::open(self.path("stdin")).unwrap();
        let ran = self.command(args).stdin(stdin).output().unwrap();
        std::fs::remove_file(self.path("stdin")).unwrap();
        ran.into()
    }

    /// Renders `scene.xml` to a name with some arguments more, and reads the picture.
    pub fn render(&self, name: &str, more: &[&str]) -> (Picture, Metadata) {
        self.run(&[&["render", "scene.xml", "-o", name], more].concat()).ok();
        self.film(&format!("{name}.exr"))
    }

    pub fn film(&self, name: &str) -> (Picture, Metadata) {
        read_exr(&self.path(name)).unwrap()
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        let ran = Self { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) };
        assert!(!ran.err.contains("panicked"), "{ran:?}");
        ran
    }
}

impl Ran {
    /// Asserts that all went well.
    #[track_caller]
    pub fn ok(self) -> Self {
        assert_eq!(self.code, Some(0), "{self:?}");
        self
    }

    /// Asserts an exit code, one error with these words, and nothing on the standard output.
    #[track_caller]
    pub fn fails(self, code: i32, words: &[&str]) -> Self {
        assert_eq!(self.code, Some(code), "{self:?}");
        assert_eq!((self.err.matches("error: ").count(), self.out.as_str()), (1, ""), "{self:?}");
        for w in words {
            assert!(self.err.contains(w), "`{w}` is not in {self:?}");
        }
        self
    }

    /// The standard output as one JSON object.
    #[track_caller]
    pub fn json(&self) -> Value {
        assert_eq!(self.err, "", "{self:?}");
        serde_json::from_str(&self.out).unwrap_or_else(|e| panic!("{e}: {self:?}"))
    }
}

/// The names of a file's channels, in its own words.
pub fn channels(path: &Path) -> Vec<String> {
    let bytes = std::fs::read(path).unwrap();
    let start = bytes.windows(14).position(|w| w == b"channels\0chlis").unwrap();
    // The attribute's type ends in "t\0" and is followed by its size; each channel by 16 bytes.
    let mut at = start + 14 + 2 + 4;
    let mut names = Vec::new();
    while bytes[at] != 0 {
        let end = at + bytes[at..].iter().position(|b| *b == 0).unwrap();
        names.push(String::from_utf8(bytes[at..end].to_vec()).unwrap());
        at = end + 1 + 16;
    }
    names
}
