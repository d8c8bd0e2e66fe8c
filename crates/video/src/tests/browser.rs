//! A real browser that plays our files, where there is one.

use std::env;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::{PATCH, PATCHES, patches, video};
use crate::VideoOptions;

/// Two for the bytes of Y′CbCr, one for the quantiser and one for the browser's own rounding; more in blue,
/// because without a GPU Chromium shows what a factor of Cb of 2 instead of 2.112 gives.
const TOLERANCE: [u8; 3] = [4, 4, 4 + 13];

const PATIENCE: Duration = Duration::from_secs(90);

/// Where Chromium is: the variable `CHROMIUM`, or one of its names in the path.
fn chromium() -> Option<PathBuf> {
    let named = env::var_os("CHROMIUM").filter(|name| !name.is_empty()).map(PathBuf::from);
    let folders: Vec<_> = env::split_paths(&env::var_os("PATH").unwrap_or_default()).collect();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let mut found = names.into_iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    named.or_else(|| found.find(|path| path.is_file()))
}

/// A page that plays a video and posts what it sees to where it comes from.
fn page(video: &[u8]) -> String {
    let bytes: Vec<_> = video.iter().map(u8::to_string).collect();
    let script = include_str!("browser.js").replace("BYTES", &bytes.join(","));
    let script = script.replace("PATCH", &PATCH.to_string());
    format!("<!doctype html><meta charset=utf-8><script>{script}</script>")
}

/// A browser that ends with its owner.
struct Browser(Child);

impl Browser {
    fn open(browser: &Path, profile: &Path, port: u16) -> io::Result<Self> {
        let child = Command::new(browser)
            .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--mute-audio"])
            .args(["--disable-dev-shm-usage", "--disable-breakpad"])
            .arg(format!("--user-data-dir={}", profile.display()))
            .arg(format!("http://127.0.0.1:{port}/"))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()?;
        Ok(Self(child))
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Serves the page until something is posted, and returns that.
fn answer(listener: &TcpListener, page: &str) -> io::Result<String> {
    let deadline = Instant::now() + PATIENCE;
    listener.set_nonblocking(true)?;
    while Instant::now() < deadline {
        match listener.accept() {
            Ok((stream, _)) => {
                // Connections that browsers open in advance are closed without a request.
                if let Ok(Some(posted)) = serve(stream, page) {
                    return Ok(posted);
                }
            }
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                thread::sleep(Duration::from_millis(20))
            }
            Err(error) => return Err(error),
        }
    }
    Err(io::ErrorKind::TimedOut.into())
}

/// Answers one request, with the page if it asks for one. What is posted is returned.
fn serve(mut stream: TcpStream, page: &str) -> io::Result<Option<String>> {
    stream.set_nonblocking(false)?;
    stream.set_read_timeout(Some(Duration::from_secs(2)))?;
    let mut reader = BufReader::new(stream.try_clone()?);
    let (mut request, mut length) = (String::new(), 0);
    reader.read_line(&mut request)?;
    let mut line = String::new();
    // A line without anything but its end closes the head.
    while reader.read_line(&mut line)? > 2 {
        if let Some(value) = line.to_ascii_lowercase().strip_prefix("content-length:") {
            length = value.trim().parse().unwrap_or(0);
        }
        line.clear();
    }
    let mut posted = vec![0; length];
    reader.read_exact(&mut posted)?;
    let (status, body) = if request.starts_with("GET / ") { ("200 OK", page) } else { ("404 Not Found", "") };
    let kind = "Content-Type: text/html; charset=utf-8\r\nConnection: close";
    write!(stream, "HTTP/1.1 {status}\r\n{kind}\r\nContent-Length: {}\r\n\r\n{body}", body.len())?;
    Ok(request.starts_with("POST").then(|| String::from_utf8_lossy(&posted).into_owned()))
}

#[test]
fn chromium_shows_the_right_colours() {
    let Some(program) = chromium() else {
        println!("skipped: no Chromium in the path, and none named by the variable CHROMIUM");
        return;
    };
    let canvas = patches();
    let options = VideoOptions { frames_per_second: 2, ..VideoOptions::new(canvas.width(), canvas.height()) };
    let mut black = canvas.clone();
    black.pixels_mut().fill([0; 3]);
    let page = page(&video(options, &[black, canvas.clone(), canvas.clone(), canvas]));

    let (folder, listener) = (TempDir::new().unwrap(), TcpListener::bind("127.0.0.1:0").unwrap());
    let port = listener.local_addr().unwrap().port();
    let browser = Browser::open(&program, folder.path(), port).expect("the browser starts");
    let seen = answer(&listener, &page).unwrap();
    drop(browser);
    if seen == "no H.264" {
        println!("skipped: this Chromium has no H.264");
        return;
    }
    println!("{seen}");
    let (head, colours) = seen.split_once('\n').unwrap();
    assert_eq!(head, "384 × 48, 2 s");
    assert_eq!(colours.lines().count(), PATCHES.len());
    for (colour, line) in PATCHES.into_iter().zip(colours.lines()) {
        let shown: Vec<u8> = line.split(' ').map(|n| n.parse().unwrap()).collect();
        let near = (0..3).all(|i| colour[i].abs_diff(shown[i]) <= TOLERANCE[i]);
        assert!(near, "{colour:?} is shown as {shown:?}");
    }
}
