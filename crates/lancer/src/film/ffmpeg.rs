//! Videos by ffmpeg, a program of its own that takes pictures from a pipe.

use crate::error::Error;
use lancer_io::image::animation::Film;
use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use tempfile::TempPath;

const PROGRAM: &str = "ffmpeg";

/// Finds out whether ffmpeg is there.
///
/// # Errors
/// It is not, and `path` cannot be written for that.
pub(super) fn check(path: &Path) -> Result<(), Error> {
    let mut command = Command::new(PROGRAM);
    command.arg("-version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(cannot(path, &format!("ffmpeg does not work here: {status}"))),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Err(cannot(
            path,
            "it takes ffmpeg, which is not on the path; install it, or name a .png, .gif or .webp file or numbered \
             pictures, as in frame_%04d.png",
        )),
        Err(error) => Err(cannot(path, &format!("ffmpeg cannot be started: {error}"))),
    }
}

fn cannot(path: &Path, reason: &str) -> Error {
    Error::Output { to: path.display().to_string(), reason: reason.to_owned() }
}

/// An ffmpeg at work. It is ended where it is dropped, and its file with it.
pub(super) struct Ffmpeg {
    child: Child,
    pictures: Option<BufWriter<ChildStdin>>,
    /// What it says.
    messages: File,
    video: TempPath,
}

impl Ffmpeg {
    /// Starts it; its file lies in `directory` until it is done.
    ///
    /// # Errors
    /// It cannot be started.
    pub(super) fn start(film: &Film, directory: &Path) -> io::Result<Self> {
        let video = tempfile::Builder::new()
            .prefix(".lancer.")
            .suffix(".mp4")
            .tempfile_in(directory)?
            .into_temp_path();
        let messages = tempfile::tempfile()?;
        let mut command = Command::new(PROGRAM);
        command
            .args(["-y", "-nostdin", "-loglevel", "error"])
            .args(["-f", "rawvideo", "-pixel_format", "rgb24"])
            .args(["-video_size", &format!("{}x{}", film.width, film.height)])
            .args(["-framerate", &film.fps.to_string()])
            .args(["-i", "pipe:0", "-an"])
            // Players want even sides, and colours as those of HDTV.
            .args(["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv"])
            .args(["-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p"])
            .args(["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1"])
            .args(["-color_range", "tv", "-movflags", "+faststart", "-f", "mp4"])
            .arg(&video)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(messages.try_clone()?);
        // A Ctrl-C is for us, who then end it.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let pictures = child.stdin.take().map(BufWriter::new);
        Ok(Self { child, pictures, messages, video })
    }

    /// Gives it a picture.
    ///
    /// # Errors
    /// It has ended, for the reason that it gave.
    pub(super) fn add(&mut self, codes: &[u8]) -> io::Result<()> {
        let written = match &mut self.pictures {
            Some(pictures) => pictures.write_all(codes),
            None => Err(io::ErrorKind::BrokenPipe.into()),
        };
        written.map_err(|error| match error.kind() {
            io::ErrorKind::BrokenPipe => self.reason().unwrap_or(error),
            _ => error,
        })
    }

    /// The video.
    ///
    /// # Errors
    /// It failed, for the reason that it gave.
    pub(super) fn finish(mut self) -> io::Result<File> {
        if let Some(mut pictures) = self.pictures.take() {
            // An end before all was read is told by its exit code.
            let _ = pictures.flush();
        }
        let status = self.child.wait()?;
        if status.success() {
            return File::open(&self.video);
        }
        Err(self.reason().unwrap_or_else(|| io::Error::other(format!("ffmpeg ended with {status}"))))
    }

    /// The last line that it said.
    fn reason(&mut self) -> Option<io::Error> {
        // It may be about to say it.
        let _ = self.child.wait();
        let mut said = Vec::new();
        self.messages.seek(SeekFrom::Start(0)).ok()?;
        (&mut self.messages).take(MOST_MESSAGES).read_to_end(&mut said).ok()?;
        let said = String::from_utf8_lossy(&said);
        let line = said.lines().map(str::trim).rfind(|line| !line.is_empty())?;
        Some(io::Error::other(format!("ffmpeg says: {line}")))
    }
}

/// Bytes of messages that are looked through.
const MOST_MESSAGES: u64 = 1 << 16;

impl Drop for Ffmpeg {
    fn drop(&mut self) {
        // Before the wait: it reads until its input ends.
        self.pictures = None;
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
