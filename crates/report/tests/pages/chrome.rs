//! A small client of Chromium's DevTools protocol: one browser, its pages, what they complain about.

use std::ffi::OsString;
use std::io::{BufRead, BufReader, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use base64::Engine;
use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

const PATIENCE: Duration = Duration::from_secs(60);

/// How a page is seen.
#[derive(Clone, Copy, Debug)]
pub struct Device {
    pub name: &'static str,
    pub width: u32,
    pub height: u32,
    pub touch: bool,
    pub dark: bool,
}

/// The browser named by CHROMIUM, or one from PATH.
fn find() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("CHROMIUM").filter(|name| !name.is_empty()) {
        return Some(named.into());
    }
    let path = std::env::var_os("PATH")?;
    let places: Vec<PathBuf> = std::env::split_paths(&path).collect();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    names.iter().flat_map(|name| places.iter().map(move |p| p.join(name))).find(|file| file.is_file())
}

/// A running browser; it ends with this value.
pub struct Browser {
    child: Child,
    socket: WebSocket<TcpStream>,
    profile: tempfile::TempDir,
    last: u64,
    complaints: Vec<String>,
}

impl Browser {
    /// Starts a browser, or says that there is none.
    pub fn start(flags: &[&str]) -> Option<Self> {
        let Some(program) = find() else {
            // Written past the test runner, which keeps to itself what passing tests print.
            let notice = "no Chromium in CHROMIUM or PATH: the pages are not tested in a browser";
            let _ = writeln!(std::io::stderr(), "{notice}");
            return None;
        };
        let profile = tempfile::tempdir().unwrap();
        let mut folder = OsString::from("--user-data-dir=");
        folder.push(profile.path());
        let fixed = "--headless=new --remote-debugging-port=0 --no-sandbox --no-first-run --disable-dev-shm-usage \
                     --hide-scrollbars --force-color-profile=srgb --enable-unsafe-swiftshader \
                     --disable-background-networking --disable-component-update --disable-sync";
        let mut child = Command::new(&program)
            .args(fixed.split_whitespace())
            .args(flags)
            .args([folder, "about:blank".into()])
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap_or_else(|e| panic!("{}: {e}", program.display()));
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let address = lines
            .find_map(|line| line.unwrap().strip_prefix("DevTools listening on ").map(str::to_owned))
            .expect("the browser says where it listens");
        // Whoever writes to a closed pipe ends.
        std::thread::spawn(move || lines.for_each(drop));
        let host = address.trim_start_matches("ws://").split('/').next().unwrap();
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let (socket, _) = tungstenite::client(address.as_str(), stream).unwrap();
        Some(Self { child, socket, profile, last: 0, complaints: Vec::new() })
    }

    /// Opens a file as a page of its own.
    pub fn open(&mut self, file: &Path, device: Device) -> Page<'_> {
        self.open_address(&format!("file://{}", file.display()), device)
    }

    pub fn open_address(&mut self, address: &str, device: Device) -> Page<'_> {
        let target = self.call(None, "Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session =
            self.call(None, "Target.attachToTarget", attach)["sessionId"].as_str().unwrap().to_owned();
        let mut page = Page { browser: self, session };
        for domain in ["Page.enable", "Runtime.enable", "Log.enable"] {
            page.call(domain, json!({}));
        }
        page.become_device(device);
        page.go(address);
        page
    }

    fn call(&mut self, session: Option<&str>, method: &str, parameters: Value) -> Value {
        self.last += 1;
        let mut request = json!({ "id": self.last, "method": method, "params": parameters });
        if let Some(session) = session {
            request["sessionId"] = session.into();
        }
        self.socket.send(Message::text(request.to_string())).unwrap();
        loop {
            let Message::Text(text) = self.socket.read().unwrap() else { continue };
            let message: Value = serde_json::from_str(&text).unwrap();
            if message["id"] == self.last {
                assert!(message.get("error").is_none(), "{method}: {}", message["error"]);
                return message["result"].clone();
            }
            self.note(&message);
        }
    }

    /// Remembers exceptions and whatever goes to the console.
    fn note(&mut self, message: &Value) {
        let about = &message["params"];
        match message["method"].as_str() {
            Some("Runtime.exceptionThrown") => self.complaints.push(about["exceptionDetails"].to_string()),
            Some("Runtime.consoleAPICalled") => self.complaints.push(about["args"].to_string()),
            Some("Log.entryAdded") if about["entry"]["level"] == "error" => {
                self.complaints.push(about["entry"].to_string());
            }
            _ => {}
        }
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // An orderly end takes the browser's own children along.
        let close = json!({ "id": 0, "method": "Browser.close" }).to_string();
        let asked = self.socket.send(Message::text(close)).is_ok();
        let deadline = Instant::now() + Duration::from_secs(5);
        while asked && Instant::now() < deadline && matches!(self.child.try_wait(), Ok(None)) {
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
        debug_assert!(self.profile.path().exists());
    }
}

/// One page. Places are in page pixels of the window.
pub struct Page<'a> {
    browser: &'a mut Browser,
    session: String,
}

impl Page<'_> {
    pub fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.browser.call(Some(&self.session), method, parameters)
    }

    fn become_device(&mut self, device: Device) {
        let Device { width, height, touch, dark, .. } = device;
        let metrics = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": touch });
        self.call("Emulation.setDeviceMetricsOverride", metrics);
        self.call("Emulation.setTouchEmulationEnabled", json!({ "enabled": touch }));
        let scheme =
            json!([{ "name": "prefers-color-scheme", "value": if dark { "dark" } else { "light" } }]);
        self.call("Emulation.setEmulatedMedia", json!({ "features": scheme }));
    }

    /// Loads an address and waits until the page is ready.
    fn go(&mut self, address: &str) {
        self.call("Page.navigate", json!({ "url": address }));
        let trouble = "!document.querySelector('#trouble').hidden";
        self.wait(&format!("document.readyState === 'complete' && (window.caustica || {trouble})"));
        self.settle();
    }

    /// The value of an expression; promises are waited for.
    pub fn eval(&mut self, expression: &str) -> Value {
        let ask = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let answer = self.call("Runtime.evaluate", ask);
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    pub fn number(&mut self, expression: &str) -> f64 {
        let value = self.eval(expression);
        value.as_f64().unwrap_or_else(|| panic!("{expression} is {value}"))
    }

    pub fn text(&mut self, selector: &str) -> String {
        let value = self.eval(&format!("document.querySelector({selector:?}).textContent"));
        value.as_str().unwrap().to_owned()
    }

    pub fn wait(&mut self, condition: &str) {
        let deadline = Instant::now() + PATIENCE;
        while !self.eval(&format!("!!({condition})")).as_bool().unwrap() {
            assert!(
                Instant::now() < deadline,
                "waited in vain for {condition}; {:?}",
                self.browser.complaints
            );
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Waits until what was changed is painted.
    pub fn settle(&mut self) {
        self.eval(
            "new Promise(done =>
               requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 20))))",
        );
    }

    /// Presses a key, such as "1", "R" or "ArrowLeft".
    pub fn key(&mut self, key: &str) {
        let mut down = json!({ "type": "keyDown", "key": key });
        if key.chars().count() == 1 {
            down["text"] = key.into();
        }
        self.call("Input.dispatchKeyEvent", down);
        self.call("Input.dispatchKeyEvent", json!({ "type": "keyUp", "key": key }));
        self.settle();
    }

    pub fn click(&mut self, selector: &str) {
        self.eval(&format!("document.querySelector({selector:?}).click()"));
        self.settle();
    }

    pub fn mouse(&mut self, kind: &str, [x, y]: [f64; 2]) {
        let button = if kind == "mouseMoved" { "none" } else { "left" };
        let event = json!({ "type": kind, "x": x, "y": y, "button": button, "buttons": 1, "clickCount": 1 });
        self.call("Input.dispatchMouseEvent", event);
    }

    pub fn hover(&mut self, [x, y]: [f64; 2]) {
        self.call("Input.dispatchMouseEvent", json!({ "type": "mouseMoved", "x": x, "y": y }));
        self.settle();
    }

    pub fn drag(&mut self, from: [f64; 2], to: [f64; 2]) {
        self.mouse("mousePressed", from);
        for part in 1..=4 {
            let at = |i: usize| from[i] + (to[i] - from[i]) * f64::from(part) / 4.0;
            self.call(
                "Input.dispatchMouseEvent",
                json!({ "type": "mouseMoved", "x": at(0), "y": at(1), "button": "left", "buttons": 1 }),
            );
        }
        self.mouse("mouseReleased", to);
        self.settle();
    }

    pub fn wheel(&mut self, [x, y]: [f64; 2], amount: f64) {
        let event = json!({ "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": amount });
        self.call("Input.dispatchMouseEvent", event);
        self.settle();
    }

    /// Moves fingers from some places to as many others.
    pub fn swipe(&mut self, from: &[[f64; 2]], to: &[[f64; 2]]) {
        for step in 0..=5 {
            let along = |(a, b): (&[f64; 2], &[f64; 2])| {
                let at = |i: usize| a[i] + (b[i] - a[i]) * f64::from(step) / 5.0;
                json!({ "x": at(0), "y": at(1) })
            };
            let points: Vec<Value> = from.iter().zip(to).map(along).collect();
            let kind = if step == 0 { "touchStart" } else { "touchMove" };
            self.call("Input.dispatchTouchEvent", json!({ "type": kind, "touchPoints": points }));
        }
        self.call("Input.dispatchTouchEvent", json!({ "type": "touchEnd", "touchPoints": [] }));
        self.settle();
    }

    pub fn tap_twice(&mut self, at: [f64; 2]) {
        // Two taps that follow each other slowly are no double tap.
        std::thread::sleep(Duration::from_millis(400));
        for _ in 0..2 {
            let point = json!([{ "x": at[0], "y": at[1] }]);
            self.call("Input.dispatchTouchEvent", json!({ "type": "touchStart", "touchPoints": point }));
            self.call("Input.dispatchTouchEvent", json!({ "type": "touchEnd", "touchPoints": [] }));
        }
        self.settle();
    }

    /// The colour that the window shows at a place.
    pub fn colour(&mut self, [x, y]: [f64; 2]) -> [u8; 3] {
        let clip = json!({ "x": x.floor(), "y": y.floor(), "width": 1, "height": 1, "scale": 1 });
        let bytes = self.screenshot(json!({ "clip": clip }));
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        [pixels[0], pixels[1], pixels[2]]
    }

    pub fn screenshot(&mut self, how: Value) -> Vec<u8> {
        let shot = self.call("Page.captureScreenshot", how);
        base64::engine::general_purpose::STANDARD.decode(shot["data"].as_str().unwrap()).unwrap()
    }

    /// What went wrong in the page since this was last asked.
    pub fn complaints(&mut self) -> Vec<String> {
        self.eval("0");
        std::mem::take(&mut self.browser.complaints)
    }
}
