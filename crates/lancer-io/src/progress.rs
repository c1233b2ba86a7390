//! How far the reading of a model's file is, for whoever shows it.

use std::fmt;
use std::sync::Arc;

/// Hears now and then how many bytes of how many have been read of a model.
///
/// It is called from whichever thread reads, some hundred times for a large file and not at all for a small one.
/// After the last call there is still work to do: smoothing, and putting meshes together.
#[derive(Clone, Default)]
pub struct ReadProgress(Option<Hook>);

/// Is given the bytes read and the bytes in all.
type Hook = Arc<dyn Fn(u64, u64) + Send + Sync>;

impl ReadProgress {
    /// Progress that is told to `hook`: the bytes read, and the bytes in all.
    pub fn new(hook: impl Fn(u64, u64) + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(hook)))
    }

    /// The pace of a reader through a file of so many bytes.
    pub(crate) fn through(&self, total: usize) -> Pace {
        let next = if self.0.is_some() { Pace::STEP } else { usize::MAX };
        Pace { hook: self.0.clone(), total, next }
    }
}

impl fmt::Debug for ReadProgress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "ReadProgress(told)" } else { "ReadProgress(untold)" })
    }
}

/// Tells the progress through one file, at every so many bytes.
pub(crate) struct Pace {
    hook: Option<Hook>,
    total: usize,
    /// Where it is told next.
    next: usize,
}

impl Pace {
    /// Bytes from one call to the next: some hundredths of a second.
    const STEP: usize = 1 << 20;

    /// The reader stands at an offset.
    #[inline]
    pub(crate) fn at(&mut self, offset: usize) {
        if offset >= self.next {
            self.tell(offset);
        }
    }

    #[cold]
    fn tell(&mut self, offset: usize) {
        self.next = offset.saturating_add(Self::STEP);
        if let Some(hook) = &self.hook {
            hook(offset as u64, self.total as u64);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn a_step_is_told_once_and_a_small_file_never() {
        let told = Arc::new(Mutex::new(Vec::new()));
        let hears = Arc::clone(&told);
        let progress = ReadProgress::new(move |read, total| hears.lock().unwrap().push((read, total)));
        let mut pace = progress.through(3 << 20);
        [0, 5, (1 << 20) - 1, 1 << 20, (1 << 20) + 9, (2 << 20) + 1].into_iter().for_each(|at| pace.at(at));
        assert_eq!(*told.lock().unwrap(), [(1 << 20, 3 << 20), ((2 << 20) + 1, 3 << 20)]);
        ReadProgress::default().through(9 << 20).at(8 << 20);
    }
}
