//! How well a few typed letters fit a name.

/// How well `query` fits `text`: the more, the better; none where some of it is not there.
///
/// Case and accents do not count. Each word that is typed is looked for by itself: best at the start of a word, then
/// anywhere, then as letters in this order, better if they start words.
pub(super) fn score(query: &str, text: &str) -> Option<i32> {
    let text = fold(text);
    let letters = text.chars().collect::<Vec<_>>();
    let words = fold(query);
    let words = words.split_whitespace().collect::<Vec<_>>();
    let mut total = 0;
    for word in &words {
        total += score_word(word, &text, &letters)?;
    }
    // Of two that fit alike, the shorter one holds less that was not asked for.
    Some(total * LENGTH_SHARE - i32::try_from(letters.len()).unwrap_or(i32::MAX / 2))
}

/// What a word of the query is worth. Only their order counts, and that three lucky letters are less than one
/// start of a word.
const STARTS_TEXT: i32 = 120;
const STARTS_WORD: i32 = 100;
const WITHIN: i32 = 60;
const SCATTERED: i32 = 10;

/// How many letters too many are worth a point: only texts that fit alike are told apart by their lengths.
const LENGTH_SHARE: i32 = 8;

fn score_word(word: &str, text: &str, letters: &[char]) -> Option<i32> {
    if text.starts_with(word) {
        return Some(STARTS_TEXT);
    }
    if text.split(|c: char| !c.is_alphanumeric()).any(|part| part.starts_with(word)) {
        return Some(STARTS_WORD);
    }
    if text.contains(word) {
        return Some(WITHIN);
    }
    scattered(word, letters)
}

/// The letters one after the other: 3 for each that starts a word, 1 for each that follows the one before.
fn scattered(word: &str, letters: &[char]) -> Option<i32> {
    let starts_word = |i: usize| i == 0 || !letters[i - 1].is_alphanumeric();
    let (mut at, mut worth) = (0, 0);
    for wanted in word.chars() {
        let rest = at..letters.len();
        let start = rest.clone().find(|&i| letters[i] == wanted && starts_word(i));
        let found = if at > 0 && letters.get(at) == Some(&wanted) { Some(at) } else { start };
        let found = found.or_else(|| rest.clone().find(|&i| letters[i] == wanted))?;
        worth += if starts_word(found) { 3 } else { i32::from(found == at) };
        at = found + 1;
    }
    Some(SCATTERED + worth.min(WITHIN - SCATTERED - 1))
}

/// Lower case without the accents of French.
pub(super) fn fold(text: &str) -> String {
    text.chars()
        .flat_map(char::to_lowercase)
        .map(|c| match c {
            'à' | 'â' | 'ä' | 'á' => 'a',
            'ç' => 'c',
            'é' | 'è' | 'ê' | 'ë' => 'e',
            'î' | 'ï' | 'í' => 'i',
            'ô' | 'ö' | 'ó' => 'o',
            'ù' | 'û' | 'ü' | 'ú' => 'u',
            'ÿ' => 'y',
            '’' => '\'',
            c => c,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn better(query: &str, one: &str, other: &str) {
        assert!(score(query, one) > score(query, other), "{query}: {one} against {other}");
    }

    #[test]
    fn the_start_of_the_text_is_best_then_of_a_word_then_within_then_scattered() {
        better("re", "Render", "Next render");
        better("re", "Next render", "Square");
        better("re", "Square", "Right side");
    }

    #[test]
    fn initials_are_better_than_letters_here_and_there() {
        better("svs", "Save view into scene", "Shadows over vessels");
    }

    #[test]
    fn all_words_must_be_there_in_any_order() {
        assert!(score("scene save", "Save view into scene file").is_some());
        assert_eq!(score("save xyz", "Save view into scene file"), None);
    }

    #[test]
    fn case_and_accents_do_not_count() {
        assert_eq!(score("deselec", "Désélectionner"), score("DÉSÉLEC", "Désélectionner"));
        assert!(score("l'image", "Copier l’image").is_some());
    }

    #[test]
    fn of_two_that_fit_alike_the_shorter_is_better() {
        better("zoom", "Zoom in", "Zoom in on what is selected in the picture");
    }

    #[test]
    fn nothing_typed_fits_everything() {
        assert!(score("", "anything").is_some());
    }
}
