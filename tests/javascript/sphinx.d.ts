// What the search page of Sphinx has before `site.js` runs.

declare const Search: {
  _index?: { terms: Record<string, number | number[]>; titles: string[]; docnames: string[] };
};
declare class Stemmer {
  stemWord(word: string): string;
}

// What `_static/texts.js` holds: the paragraphs of each page.

declare const TEXTS: Record<string, string[]>;
