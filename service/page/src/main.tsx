import {render} from 'preact';
import 'uplot/dist/uPlot.min.css';
import './style.css';
import {takeToken} from './api/token.ts';
import {Desk} from './model/desk.ts';
import {App} from './view/app.tsx';

const place = document.getElementById('page');
if (place) {
  const desk = new Desk(takeToken());
  place.replaceChildren();
  render(<App desk={desk} />, place);
  desk.start();
}
