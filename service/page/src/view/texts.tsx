import {createContext} from 'preact';
import {useContext, useState} from 'preact/hooks';
import {cut, type Language} from '../model/format.ts';
import {sayIn, type Say} from '../words/words.ts';

export const LanguageContext = createContext<Language>('en');

export const useLanguage = (): Language => useContext(LanguageContext);
export const useSay = (): Say => sayIn(useContext(LanguageContext));

/** A text from elsewhere: text only, and a long one cut with a way to see all. */
export function OuterText({text, isEnglish}: {text: string; isEnglish?: boolean}) {
  const say = useSay();
  const [whole, setWhole] = useState(false);
  const start = cut(text);
  const lang = isEnglish ? 'en' : undefined;  // the daemon's sentences are
  if (start === null) return <span class="outer" lang={lang}>{text}</span>;
  return (
    <span class="outer" lang={lang}>
      {whole ? text : `${start}…`}{' '}
      <button type="button" class="small" aria-expanded={whole} onClick={() => setWhole(!whole)}>
        {whole ? say('showLess') : say('showAll', {count: text.length})}
      </button>
    </span>
  );
}
