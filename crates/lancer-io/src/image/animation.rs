//! Pictures that move: APNG, GIF and WebP.
//!
//! In: frames of 8-bit sRGB, one after another. Out: bytes, the same for the same frames. All loop for ever. PNG and
//! WebP keep every code; GIF has 256 colours, one palette for all frames, so that nothing flickers.

use super::Metadata;
use color_quant::NeuQuant;
use image_webp::{ColorType, WebPEncoder};
use std::io::{self, Write};
use std::path::Path;

/// The formats of animations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnimationFormat {
    /// APNG: lossless, in a file that other programs show as its first frame.
    Png,
    /// GIF: 256 colours; shown everywhere.
    Gif,
    /// WebP: lossless, and smaller than APNG.
    WebP,
}

/// The size and the pace of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Film {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Frames, at least 1.
    pub frames: u32,
    /// Frames a second, at least 1.
    pub fps: u16,
}

/// Why a format cannot hold a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FilmError {
    /// A side is too long.
    #[error("{format} holds at most {most} pixels a side, and {found} were asked for")]
    Side {
        /// The format's name.
        format: &'static str,
        /// The longest side.
        most: u32,
        /// The longer of the film's.
        found: u32,
    },
    /// Its frames follow one another too fast.
    #[error("GIF shows at most {} frames a second, and {found} were asked for", Film::MOST_GIF_FPS)]
    Fps {
        /// The frames a second.
        found: u16,
    },
    /// It has too many pixels for its palette to be found.
    #[error("a GIF of {mebibytes} MiB of frames is more than {} MiB", Film::MOST_GIF_BYTES >> 20)]
    Bytes {
        /// The size of all frames.
        mebibytes: u64,
    },
}

impl AnimationFormat {
    /// The format that a file's extension asks for, in any case.
    pub fn from_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_ascii_lowercase().to_str()? {
            "png" | "apng" => Some(Self::Png),
            "gif" => Some(Self::Gif),
            "webp" => Some(Self::WebP),
            _ => None,
        }
    }

    /// Whether it can hold a film; to be asked before its frames are rendered.
    ///
    /// # Errors
    /// See [`FilmError`].
    pub fn check(self, film: &Film) -> Result<(), FilmError> {
        let (format, most) = match self {
            Self::Png => return Ok(()),
            Self::Gif => ("GIF", u32::from(u16::MAX)),
            Self::WebP => ("WebP", 1 << 14),
        };
        let found = film.width.max(film.height);
        if found > most {
            return Err(FilmError::Side { format, most, found });
        }
        if self == Self::Gif && film.fps > Film::MOST_GIF_FPS {
            return Err(FilmError::Fps { found: film.fps });
        }
        let bytes = film.pixels() * 3 * u64::from(film.frames);
        if self == Self::Gif && bytes > Film::MOST_GIF_BYTES {
            return Err(FilmError::Bytes { mebibytes: bytes >> 20 });
        }
        Ok(())
    }
}

impl Film {
    /// Browsers slow down what is faster.
    const MOST_GIF_FPS: u16 = 50;
    /// All frames are held until the palette is known.
    const MOST_GIF_BYTES: u64 = 2 << 30;

    /// Pixels of a frame.
    fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// How long a frame is shown, in whole units of which a second has `units`. The remainders are carried on, so
    /// that a long film does not run away from its pace.
    fn duration(&self, frame: u32, units: u64) -> u64 {
        let end = |frames: u64| (frames * units + u64::from(self.fps) / 2) / u64::from(self.fps);
        end(u64::from(frame) + 1) - end(u64::from(frame))
    }
}

/// Writes an animation frame by frame.
pub struct AnimationWriter<W: Write> {
    film: Film,
    written: u32,
    encoder: Encoder<W>,
}

enum Encoder<W: Write> {
    Png(Box<png::Writer<W>>),
    Gif { out: W, frames: Vec<Vec<[u8; 3]>> },
    WebP { out: W, chunks: Vec<u8> },
}

impl<W: Write> AnimationWriter<W> {
    /// Begins an animation.
    ///
    /// # Errors
    /// The format cannot hold it, it has no frame or no pixel, or `out` fails.
    pub fn new(format: AnimationFormat, film: Film, metadata: &Metadata, out: W) -> io::Result<Self> {
        format.check(&film).map_err(|error| invalid(error.to_string()))?;
        if film.pixels() == 0 || film.frames == 0 || film.fps == 0 {
            return Err(invalid("an animation without pixels, frames or pace"));
        }
        let encoder = match format {
            AnimationFormat::Png => Encoder::Png(Box::new(begin_png(&film, metadata, out)?)),
            AnimationFormat::Gif => Encoder::Gif { out, frames: Vec::new() },
            AnimationFormat::WebP => Encoder::WebP { out, chunks: Vec::new() },
        };
        Ok(Self { film, written: 0, encoder })
    }

    /// Adds the next frame. Shape: `[height * width][3]`, top row first.
    ///
    /// # Errors
    /// It has another size than the film, or is one too many; or `out` fails.
    pub fn add(&mut self, frame: &[[u8; 3]]) -> io::Result<()> {
        if frame.len() as u64 != self.film.pixels() || self.written == self.film.frames {
            return Err(invalid("a frame of another size than the film, or one too many"));
        }
        match &mut self.encoder {
            Encoder::Png(writer) => writer.write_image_data(frame.as_flattened())?,
            Encoder::Gif { frames, .. } => frames.push(frame.to_vec()),
            Encoder::WebP { chunks, .. } => webp_frame(&self.film, self.written, frame, chunks)?,
        }
        self.written += 1;
        Ok(())
    }

    /// Ends the animation.
    ///
    /// # Errors
    /// Frames are missing, or `out` fails.
    pub fn finish(self) -> io::Result<()> {
        if self.written != self.film.frames {
            return Err(invalid("frames are missing"));
        }
        match self.encoder {
            Encoder::Png(writer) => Ok(writer.finish()?),
            Encoder::Gif { out, frames } => write_gif(&self.film, &frames, out),
            Encoder::WebP { out, chunks } => write_webp(&self.film, &chunks, out),
        }
    }
}

fn invalid(message: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, message)
}

fn begin_png<W: Write>(film: &Film, metadata: &Metadata, out: W) -> io::Result<png::Writer<W>> {
    let mut encoder = png::Encoder::new(out, film.width, film.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_filter(png::Filter::Adaptive);
    encoder.add_text_chunk("Software".to_owned(), metadata.software.clone())?;
    // Played for ever.
    encoder.set_animated(film.frames, 0)?;
    encoder.set_frame_delay(1, film.fps)?;
    Ok(encoder.write_header()?)
}

/// One frame's chunk: its place, its duration, and a lossless picture.
///
/// Source: the WebP container specification, "Animation".
fn webp_frame(film: &Film, index: u32, frame: &[[u8; 3]], chunks: &mut Vec<u8>) -> io::Result<()> {
    /// `RIFF`, a size and `WEBP`, which stand before the chunks of a still picture.
    const FILE_HEADER: usize = 12;
    /// The frame replaces what was there, and stays.
    const DO_NOT_BLEND: u8 = 2;
    let mut still = Vec::new();
    let encoder = WebPEncoder::new(&mut still);
    encoder
        .encode(frame.as_flattened(), film.width, film.height, ColorType::Rgb8)
        .map_err(|error| io::Error::other(error.to_string()))?;
    let mut payload = Vec::with_capacity(still.len() + 4);
    for number in [0, 0, film.width - 1, film.height - 1, film.duration(index, 1000) as u32] {
        payload.extend_from_slice(&number.to_le_bytes()[..3]);
    }
    payload.push(DO_NOT_BLEND);
    payload.extend_from_slice(&still[FILE_HEADER..]);
    chunk(*b"ANMF", &payload, chunks)
}

fn write_webp(film: &Film, frames: &[u8], mut out: impl Write) -> io::Result<()> {
    const HAS_ANIMATION: u8 = 2;
    let mut head = Vec::new();
    let mut features = vec![HAS_ANIMATION, 0, 0, 0];
    features.extend_from_slice(&(film.width - 1).to_le_bytes()[..3]);
    features.extend_from_slice(&(film.height - 1).to_le_bytes()[..3]);
    chunk(*b"VP8X", &features, &mut head)?;
    // A background that is never seen, and no end.
    chunk(*b"ANIM", &[0xff, 0xff, 0xff, 0xff, 0, 0], &mut head)?;
    let size = size_of_chunk(b"WEBP".len() + head.len() + frames.len())?;
    out.write_all(b"RIFF")?;
    out.write_all(&size.to_le_bytes())?;
    out.write_all(b"WEBP")?;
    out.write_all(&head)?;
    out.write_all(frames)?;
    out.flush()
}

fn chunk(name: [u8; 4], payload: &[u8], chunks: &mut Vec<u8>) -> io::Result<()> {
    chunks.extend_from_slice(&name);
    chunks.extend_from_slice(&size_of_chunk(payload.len())?.to_le_bytes());
    chunks.extend_from_slice(payload);
    // Chunks begin at even places.
    chunks.extend(std::iter::repeat_n(0, payload.len() % 2));
    Ok(())
}

fn size_of_chunk(bytes: usize) -> io::Result<u32> {
    u32::try_from(bytes).map_err(|_| invalid("a WebP file holds at most 4 GiB"))
}

fn write_gif(film: &Film, frames: &[Vec<[u8; 3]>], out: impl Write) -> io::Result<()> {
    let to_io = |error: gif::EncodingError| match error {
        gif::EncodingError::Io(error) => error,
        other => io::Error::other(other.to_string()),
    };
    let mut palette = Palette::of(frames);
    // `check` has seen to it that these fit.
    let (width, height) = (film.width as u16, film.height as u16);
    let mut encoder = gif::Encoder::new(out, width, height, &palette.colors()).map_err(to_io)?;
    encoder.set_repeat(gif::Repeat::Infinite).map_err(to_io)?;
    for (index, pixels) in (0..).zip(frames) {
        let frame = gif::Frame {
            width,
            height,
            delay: u16::try_from(film.duration(index, 100)).unwrap_or(u16::MAX),
            buffer: palette.dithered(pixels, film.width as usize).into(),
            ..gif::Frame::default()
        };
        encoder.write_frame(&frame).map_err(to_io)?;
    }
    encoder.into_inner().map_err(to_io)?.flush()
}

/// 256 colours, and which of them is nearest to each.
struct Palette {
    network: NeuQuant,
    /// By the upper bits of red, green and blue; found when first asked for.
    nearest: Vec<Option<u8>>,
}

impl Palette {
    const COLORS: usize = 256;
    /// Pixels that the palette is learned from, spread over all frames. More takes longer, and shows no difference.
    const MOST_LEARNED: usize = 1 << 18;
    /// Fewer leave the palette as it was before it learned: then they are learned again and again.
    const LEAST_LEARNED: usize = 1 << 16;
    /// Bits of a channel by which the nearest colour is looked up: finer than the dither.
    const BITS: u32 = 6;
    /// The greatest change of a code by the dither, about half of the distance of two colours of the palette: less
    /// leaves bands, more is grain.
    const DITHER: i32 = 6;

    fn of(frames: &[Vec<[u8; 3]>]) -> Self {
        let all = frames.iter().map(Vec::len).sum::<usize>();
        let step = all.div_ceil(Self::MOST_LEARNED);
        let pixels = frames.iter().flatten().step_by(step);
        let count = pixels.clone().count().max(Self::LEAST_LEARNED);
        let learned = pixels.cycle().take(count).flat_map(|&[r, g, b]| [r, g, b, u8::MAX]);
        let network = NeuQuant::new(1, Self::COLORS, &learned.collect::<Vec<_>>());
        Self { network, nearest: vec![None; 1 << (3 * Self::BITS)] }
    }

    /// Shape: `[256][3]`, flat.
    fn colors(&self) -> Vec<u8> {
        self.network.color_map_rgb()
    }

    /// A frame's places in the palette. Each pixel is first made a little lighter or darker by a pattern that is
    /// the same in all frames: smooth surfaces keep their shades, and what stands still does not shimmer.
    fn dithered(&mut self, pixels: &[[u8; 3]], width: usize) -> Vec<u8> {
        let place_of = |(index, pixel): (usize, &[u8; 3])| {
            let change = threshold(index % width, index / width);
            self.place_of(pixel.map(|code| (i32::from(code) + change).clamp(0, 255) as u8))
        };
        pixels.iter().enumerate().map(place_of).collect()
    }

    fn place_of(&mut self, [r, g, b]: [u8; 3]) -> u8 {
        let part = |code: u8| usize::from(code >> (8 - Self::BITS));
        let key = (part(r) << Self::BITS | part(g)) << Self::BITS | part(b);
        let network = &self.network;
        let middle = |code: u8| code & !((1 << (8 - Self::BITS)) - 1) | 1 << (7 - Self::BITS);
        let find = || network.index_of(&[middle(r), middle(g), middle(b), u8::MAX]) as u8;
        *self.nearest[key].get_or_insert_with(find)
    }
}

/// By how much a pixel's codes change: Bayer's matrix of 8 x 8, from `-Palette::DITHER` to `Palette::DITHER`.
///
/// Source: Bayer, "An optimum method for two-level rendition of continuous-tone pictures" (1973).
fn threshold(x: usize, y: usize) -> i32 {
    // The bits of x ^ y and y, interleaved and in reverse.
    let (a, b) = (x ^ y, y);
    let rank = (0..3).fold(0, |rank, bit| rank << 2 | (a >> bit & 1) << 1 | (b >> bit & 1));
    (rank as i32 * 2 - 63) * Palette::DITHER / 63
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILM: Film = Film { width: 9, height: 7, frames: 5, fps: 30 };

    /// A gradient that moves.
    fn frame(index: u32) -> Vec<[u8; 3]> {
        let pixel = |place: u32| [place * 4, index * 50, 255 - place * 3].map(|code| code as u8);
        (0..FILM.width * FILM.height).map(pixel).collect()
    }

    fn written(format: AnimationFormat) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut writer = AnimationWriter::new(format, FILM, &Metadata::default(), &mut bytes).unwrap();
        (0..FILM.frames).for_each(|index| writer.add(&frame(index)).unwrap());
        writer.finish().unwrap();
        bytes
    }

    #[test]
    fn apng_gives_back_every_frame() {
        let bytes = written(AnimationFormat::Png);
        let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
        let control = *reader.info().animation_control().unwrap();
        assert_eq!((control.num_frames, control.num_plays), (FILM.frames, 0));
        for index in 0..FILM.frames {
            let mut codes = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut codes).unwrap();
            assert_eq!(codes, frame(index).as_flattened());
            let shown = reader.info().frame_control().unwrap();
            assert_eq!((shown.delay_num, shown.delay_den), (1, 30));
        }
    }

    #[test]
    fn webp_gives_back_every_frame() {
        let bytes = written(AnimationFormat::WebP);
        let mut decoder = image_webp::WebPDecoder::new(io::Cursor::new(bytes)).unwrap();
        assert!(decoder.is_animated() && !decoder.has_alpha());
        assert_eq!((decoder.dimensions(), decoder.num_frames()), ((9, 7), FILM.frames));
        assert_eq!(decoder.loop_count(), image_webp::LoopCount::Forever);
        let durations = (0..FILM.frames).map(|index| {
            let mut codes = vec![0; decoder.output_buffer_size().unwrap()];
            let duration = decoder.read_frame(&mut codes).unwrap();
            assert_eq!(codes, frame(index).as_flattened());
            duration
        });
        assert_eq!(durations.collect::<Vec<_>>(), [33, 34, 33, 33, 34]);
    }

    #[test]
    fn gif_gives_back_every_frame_within_its_palette() {
        let bytes = written(AnimationFormat::Gif);
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(&bytes[..]).unwrap();
        assert_eq!((decoder.width(), decoder.height()), (9, 7));
        assert_eq!(decoder.repeat(), gif::Repeat::Infinite);
        let mut delays = Vec::new();
        for index in 0..FILM.frames {
            let found = decoder.read_next_frame().unwrap().unwrap();
            delays.push(found.delay);
            assert_eq!(found.buffer.len(), 9 * 7 * 4);
            for (found, expected) in found.buffer.chunks_exact(4).zip(frame(index)) {
                for (&found, expected) in found.iter().zip(expected) {
                    assert!(found.abs_diff(expected) < 32, "{found} is not {expected}");
                }
            }
        }
        assert!(decoder.read_next_frame().unwrap().is_none());
        assert_eq!(delays, [3, 4, 3, 3, 4]);
    }

    #[test]
    fn one_pixel_of_one_frame_is_an_animation() {
        let film = Film { width: 1, height: 1, frames: 1, fps: 1 };
        for format in [AnimationFormat::Png, AnimationFormat::Gif, AnimationFormat::WebP] {
            let mut bytes = Vec::new();
            let mut writer = AnimationWriter::new(format, film, &Metadata::default(), &mut bytes).unwrap();
            writer.add(&[[10, 200, 30]]).unwrap();
            writer.finish().unwrap();
            assert!(bytes.len() > 20, "{format:?}");
        }
    }

    #[test]
    fn frames_that_are_missing_too_many_or_of_another_size_are_refused() {
        for format in [AnimationFormat::Png, AnimationFormat::Gif, AnimationFormat::WebP] {
            let begin = || AnimationWriter::new(format, FILM, &Metadata::default(), io::sink()).unwrap();
            let mut writer = begin();
            assert!(writer.add(&[[0; 3]]).is_err());
            (0..FILM.frames).for_each(|index| writer.add(&frame(index)).unwrap());
            assert!(writer.add(&frame(0)).is_err());
            let mut writer = begin();
            writer.add(&frame(0)).unwrap();
            assert!(writer.finish().is_err());
        }
    }

    #[test]
    fn what_a_format_cannot_hold_is_refused_before_any_frame() {
        let check =
            |format: AnimationFormat, film: Film| format.check(&film).map_err(|error| error.to_string());
        let wide = Film { width: 20_000, ..FILM };
        assert!(check(AnimationFormat::WebP, wide).unwrap_err().contains("16384"));
        assert_eq!(check(AnimationFormat::Gif, wide), Ok(()));
        assert!(check(AnimationFormat::Gif, Film { fps: 60, ..FILM }).unwrap_err().contains("50"));
        let long = Film { width: 4000, height: 3000, frames: 100, fps: 25 };
        assert!(check(AnimationFormat::Gif, long).unwrap_err().contains("MiB"));
        assert_eq!(check(AnimationFormat::Png, long), Ok(()));
    }

    #[test]
    fn the_dither_is_even() {
        let all = (0..64).map(|i| threshold(i % 8, i / 8)).collect::<Vec<_>>();
        assert_eq!(all.iter().sum::<i32>(), 0);
        assert_eq!((all.iter().min(), all.iter().max()), (Some(&-Palette::DITHER), Some(&Palette::DITHER)));
    }

    #[test]
    fn durations_add_up_to_the_pace() {
        for fps in [1, 7, 24, 30, 50] {
            let film = Film { fps, ..FILM };
            for units in [100, 1000] {
                let second = (0..u32::from(fps)).map(|frame| film.duration(frame, units)).sum::<u64>();
                assert_eq!(second, units, "{fps} frames a second");
            }
        }
    }
}
