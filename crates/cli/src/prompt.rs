use std::io::{BufRead, Write, stderr, stdin};

use caustica::LightImage;

use crate::args::LightImageChoice;

/// What becomes of the light image; asks on the standard error if that is the choice and there is one.
pub fn light_image(choice: LightImageChoice, there_is_one: bool) -> LightImage {
    match choice {
        LightImageChoice::Off => LightImage::Off,
        LightImageChoice::Only => LightImage::Only,
        LightImageChoice::Ask if there_is_one => ask(&mut stdin().lock(), &mut stderr()),
        LightImageChoice::On | LightImageChoice::Ask => LightImage::On,
    }
}

/// Asks until an answer is understood. No answer, or no one to answer, means yes.
fn ask(answers: &mut impl BufRead, questions: &mut impl Write) -> LightImage {
    loop {
        // A question that cannot be shown can still be answered.
        let _ =
            write!(questions, "Add the light image, which holds most caustics, to the picture? [Y/n/only] ")
                .and_then(|()| questions.flush());
        let mut answer = String::new();
        let read = answers.read_line(&mut answer);
        if matches!(read, Err(_) | Ok(0)) {
            let _ = writeln!(questions);
            return LightImage::On;
        }
        match answer.trim().to_ascii_lowercase().as_str() {
            "" | "y" | "yes" | "on" => return LightImage::On,
            "n" | "no" | "off" => return LightImage::Off,
            "o" | "only" => return LightImage::Only,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_understood_or_asked_for_again() {
        for (answers, expected) in [
            ("y\n", LightImage::On),
            ("\n", LightImage::On),
            ("", LightImage::On),
            ("No\n", LightImage::Off),
            ("only", LightImage::Only),
            ("what?\nn\n", LightImage::Off),
            ("what?", LightImage::On),
        ] {
            assert_eq!(ask(&mut answers.as_bytes(), &mut std::io::sink()), expected, "{answers:?}");
        }
        assert_eq!(ask(&mut &b"\xff\xfe\nn\n"[..], &mut std::io::sink()), LightImage::On);
    }
}
