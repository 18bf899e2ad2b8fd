import {render} from 'preact';
import 'uplot/dist/uPlot.min.css';
import './style.css';
import {takeToken} from './api/token.ts';
import {Desk} from './model/desk.ts';
import {App} from './view/app.tsx';
import {firstLanguage} from './view/settings.ts';
import {loadLanguage} from './words/words.ts';

const place = document.getElementById('page');
if (place) {
  const desk = new Desk(takeToken());
  // The first words shown are those of the language that was chosen; without its file they are English.
  void loadLanguage(firstLanguage()).catch(() => {}).then(() => {
    place.replaceChildren();
    render(<App desk={desk} />, place);
    desk.start();
  });
}
