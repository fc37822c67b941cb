/** The page. */
import { App } from './app';
import { setLanguage } from './text';
import { setting } from './keeping/store';

const chosen = setting('language');
const own = navigator.language.toLowerCase().startsWith('zh') ? 'zh' : 'en';
const host = document.getElementById('app');
/** So long the texts of another language may take. */
const TEXTS_MS = 4000;
let begun = false;
const begin = (): void => {
  if (host && !begun) new App(host).begin();
  begun = true;
};
// The program takes the thread for a while: what the page itself holds is painted before. A page that is hidden, or was
// hidden meanwhile, is never painted.
const paintAndBegin = (): void => {
  if (document.hidden) begin();
  else requestAnimationFrame(() => setTimeout(begin));
  setTimeout(begin, 500);
};
// Without its texts, or if they take too long, the page begins in English.
setLanguage(chosen === 'zh' || chosen === 'en' ? chosen : own).then(paintAndBegin, paintAndBegin);
setTimeout(begin, TEXTS_MS);

// Only a page of its own server may keep itself for later: not a file, not a page under development.
if (import.meta.env.PROD && 'serviceWorker' in navigator && window.isSecureContext) {
  navigator.serviceWorker.register('./sw.js').catch(() => undefined);
}
