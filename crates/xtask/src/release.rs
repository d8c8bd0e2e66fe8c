//! The released program: that it builds by the README's command, and draws what the tests' program draws.

use std::fs;

use crate::command::{Outcome, Trouble, program, root, run};

/// The README's command and the same without optimisation at link time, each with the folder of its picture.
const BUILDS: [(&str, &[&str]); 2] = [("released", &["--release"]), ("tested", &[])];

/// Renders the built-in scene by both; fails unless the pictures are the same to the byte.
pub fn release() -> Outcome {
    let folder = root().join("target/nightly");
    fs::create_dir_all(&folder).map_err(|e| Trouble::Failed(format!("{}: {e}", folder.display())))?;
    let mut pictures = Vec::new();
    for (name, profile) in BUILDS {
        let picture = format!("target/nightly/{name}.png");
        let mut command = program(&["cargo", "run", "--locked"]);
        command.args(profile).args(["--", "render", "--spp", "16", "--quiet", "-o", &picture]);
        run(command)?;
        let read = fs::read(root().join(&picture));
        pictures.push(read.map_err(|e| Trouble::Failed(format!("{picture}: {e}")))?);
    }
    same(&pictures)
}

fn same(pictures: &[Vec<u8>]) -> Outcome {
    if pictures.windows(2).all(|pair| pair[0] == pair[1]) {
        Ok(())
    } else {
        Err(Trouble::Failed("the released program draws another picture than the tested one".into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_picture_is_a_failure() {
        assert_eq!(same(&[vec![1, 2], vec![1, 2]]), Ok(()));
        assert!(matches!(same(&[vec![1, 2], vec![1, 3]]), Err(Trouble::Failed(_))));
    }
}
