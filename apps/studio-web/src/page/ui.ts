/** Small pieces of the page: elements, icons, notes, dialogs. */
import { t } from '../text';

type Child = Node | string;

/** An element with attributes and children; `on...` are listeners. */
export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Record<string, string | ((e: Event) => void)> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const e = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') e.addEventListener(name.replace(/^on/, ''), value);
    else e.setAttribute(name, value);
  }
  e.append(...children);
  return e;
}

const watched = new WeakSet<Element>();
/** Fields with a text that nothing has taken yet. */
const untaken = new WeakSet<EventTarget>();
/** A panel is being filled anew: what a browser tells of a field that goes is no wish of a person. */
let renewing = false;

/** Fills `host` anew. The element that had the focus, by an attribute, has it again, and what was being typed there stays. */
export function refill(host: HTMLElement, attribute: 'data-key' | 'data-path', fill: () => void): void {
  if (!watched.has(host)) {
    watched.add(host);
    host.addEventListener('input', (e) => e.target && untaken.add(e.target), { capture: true });
    const taken = (e: Event): void => {
      if (renewing) e.stopImmediatePropagation();
      else if (e.target) untaken.delete(e.target);
    };
    host.addEventListener('change', taken, { capture: true });
  }
  const had = host.contains(document.activeElement) ? document.activeElement : null;
  const name = had?.getAttribute(attribute);
  const typed = had instanceof HTMLInputElement && untaken.has(had) ? had.value : undefined;
  renewing = true;
  try {
    fill();
  } finally {
    renewing = false;
  }
  const has = name ? host.querySelector<HTMLElement>(`[${attribute}="${CSS.escape(name)}"]`) : null;
  has?.focus({ preventScroll: true });
  if (typed === undefined || !(has instanceof HTMLInputElement) || has === had) return;
  has.value = typed;
  untaken.add(has);
  // A browser tells of a change only what was typed into this very element.
  const take = (): void => {
    if (!renewing && untaken.has(has)) has.dispatchEvent(new Event('change', { bubbles: true }));
  };
  has.addEventListener('blur', take);
  has.addEventListener('keyup', (e) => {
    if (e.key === 'Enter') take();
  });
}

/** Line icons on a grid of 24. */
const PATHS = {
  parts:
    'M4 20l1.2-4.4L16.500 4.300a1.900 1.900 0 0 1 2.700 0l.5.5a1.900 1.900 0 0 1 0 2.700L8.400 18.800zM14.500 6.300l3.200 3.200',
  'branch-contour': 'M12 21v-6m0 0l-4-4m4 4l4.500-5M8 11V8m0 3H5.500M16.500 10l.3-3m-.3 3l2.700-.4',
  'leaf-contour': 'M6 19c-2-8 3-14 13-14c1 10-5 15-11 13M5 21c2-5 5-8 9-10',
  erase:
    'M9 19l-5-5a1.500 1.500 0 0 1 0-2l7.500-7.500a1.500 1.500 0 0 1 2 0l5.500 5.500a1.500 1.500 0 0 1 0 2L12 19zM7.500 8.500l7.500 7.500M9 19h11',
  select: 'M6 4l12 7-5.2 1.700L9.500 18z',
  lasso:
    'M7.800 14.400C5.200 13.400 3.500 11.600 3.500 9.500C3.500 6.300 7 4 12 4s8.500 2.300 8.500 5.500S17 15 12 15c-1.500 0-3-.2-4.200-.6zM7.800 14.400c-1.500-.6-3 .3-3 1.500s1.300 1.500 2.200 1c.9-.6 1-1.600.8-2.500zM6 17c.2 1.600-.4 3-1.700 4',
  dropper:
    'M4 20l1-3.500L13.500 8l2.500 2.500L7.500 19zM12 6.500l5.500 5.500M14.700 9.300l3-3a1.800 1.800 0 0 0-2.500-2.500l-3 3',
  turns:
    'M12 12V6M12 12l5.200 3M12 12l-5.200 3M12 2a2 2 0 1 1 0 4a2 2 0 0 1 0-4zM18.900 14a2 2 0 1 1 0 4a2 2 0 0 1 0-4zM5.100 14a2 2 0 1 1 0 4a2 2 0 0 1 0-4z',
  'arrange-left': 'M4 4v16M8 7h11v4H8zM8 14h7v4H8z',
  'arrange-centre': 'M12 3v4m0 4v3m0 4v3M6 7h12v4H6zM8.500 14h7v4h-7z',
  'arrange-right': 'M20 4v16M5 7h11v4H5zM9 14h7v4H9z',
  'arrange-top': 'M4 4h16M7 8h4v11H7zM14 8h4v7h-4z',
  'arrange-middle': 'M3 12h4m4 0h3m4 0h3M7 6h4v12H7zM14 8.500h4v7h-4z',
  'arrange-bottom': 'M4 20h16M7 5h4v11H7zM14 9h4v7h-4z',
  'arrange-across': 'M4 4v16M20 4v16M9.500 8h5v8h-5z',
  'arrange-upward': 'M4 4h16M4 20h16M8 9.500h8v5H8z',
  rub: 'M3 17c3-3 5-4 7-4M16 9c2-2 3.500-3 5-3.500M11 8.500l5 5-3 3a1.500 1.500 0 0 1-2 0l-3-3a1.500 1.500 0 0 1 0-2z',
  pull: 'M3 19c4 0 5-9 9-9s5 9 9 9M12 10V3.500m0 0L9.500 6M12 3.500L14.500 6',
  folds: 'M6 9.500l6 6l6-6',
  unfolds: 'M9.500 6l6 6l-6 6',
  fit: 'M4 9V5a1 1 0 0 1 1-1h4M15 4h4a1 1 0 0 1 1 1v4M20 15v4a1 1 0 0 1-1 1h-4M9 20H5a1 1 0 0 1-1-1v-4',
  undo: 'M9 7L4.500 11.500L9 16M5 11.500h9a5 5 0 0 1 0 10h-2',
  redo: 'M15 7l4.500 4.500L15 16M19 11.500h-9a5 5 0 0 0 0 10h2',
  dice: 'M5.500 4h13A1.500 1.500 0 0 1 20 5.500v13a1.500 1.500 0 0 1-1.500 1.500h-13A1.500 1.500 0 0 1 4 18.500v-13A1.500 1.500 0 0 1 5.500 4zM8.500 8.500h.01M15.500 8.500h.01M12 12h.01M8.500 15.500h.01M15.500 15.500h.01',
  open: 'M4 19V6a1 1 0 0 1 1-1h4.500l2 2.500H18a1 1 0 0 1 1 1V11M4 19l2.300-7.200A1 1 0 0 1 7.300 11H20.500l-2.300 8z',
  save: 'M5 4h11l4 4v11a1 1 0 0 1-1 1H5a1 1 0 0 1-1-1V5a1 1 0 0 1 1-1zM8 4v5h7V4M7.500 20v-6.500h9V20',
  export: 'M12 15V4m0 0L8 8m4-4l4 4M5 14v5a1 1 0 0 0 1 1h12a1 1 0 0 0 1-1v-5',
  samples: 'M4 5h7v7H4zM13 5h7v7h-7zM4 14h7v6H4zM13 14h7v6h-7z',
  settings:
    'M4 7h9m5 0h2M4 17h3m5 0h8M15.500 4.800a2.200 2.200 0 1 1 0 4.400a2.200 2.200 0 0 1 0-4.400zM9.500 14.800a2.200 2.200 0 1 1 0 4.400a2.200 2.200 0 0 1 0-4.400z',
  theme: 'M12 4a8 8 0 1 0 0 16zM12 4a8 8 0 0 1 0 16',
  help: 'M12 3.500a8.500 8.500 0 1 1 0 17a8.500 8.500 0 0 1 0-17zM9.500 9.500a2.500 2.500 0 1 1 3.600 2.300c-.8.400-1.100.9-1.100 1.900M12 16.800h.01',
  front:
    'M5 4h14v16H5zM12 16v-5m0 0c-2.500 0-3.500-1.500-3.500-3.500c2.300 0 3.500 1.300 3.500 3.500zm0 2c2.200 0 3.300-1.300 3.300-3c-2 0-3.300 1-3.300 3z',
  wire: 'M12 3.500l7.500 4.300v8.400L12 20.500l-7.500-4.300V7.800zM4.500 7.800L12 12l7.500-4.200M12 12v8.500',
  fresh: 'M6 3.500h8l4.500 4.500v12.500H6zM14 3.500V8h4.500M12 11v6m-3-3h6',
  documents: 'M5 5h4v14.500H5zM9 8h4v11.500H9zM14 8.200l3.500-1 3 11.500-3.500 1zM3 21.500h18',
  copy: 'M8.500 8.500H19v11H8.500zM15.500 8.500v-4H5v11h3.500',
  bin: 'M5 7h14M9.500 7V4.500h5V7M7 7l.8 12.500h8.400L17 7M10.500 10.500v6M13.500 10.500v6',
  close: 'M6 6l12 12M18 6L6 18',
  lock: 'M7 11h10a1 1 0 0 1 1 1v7a1 1 0 0 1-1 1H7a1 1 0 0 1-1-1v-7a1 1 0 0 1 1-1zM8.500 11V8a3.500 3.500 0 0 1 7 0v3',
  unlock:
    'M7 11h10a1 1 0 0 1 1 1v7a1 1 0 0 1-1 1H7a1 1 0 0 1-1-1v-7a1 1 0 0 1 1-1zM8.500 11V7.500a3.500 3.500 0 0 1 6.800-1.200',
  grid: 'M4 4h4.500v4.500H4zM9.800 4h4.500v4.500H9.800zM15.500 4H20v4.500h-4.500zM4 9.800h4.500v4.500H4zM9.800 9.800h4.500v4.500H9.800zM15.500 9.800H20v4.500h-4.500zM4 15.500h4.500V20H4zM9.800 15.500h4.500V20H9.800zM15.500 15.500H20V20h-4.500z',
  photo: 'M4 5.500h16v13H4zM4 15.500l4.500-4.500l4 4l2.500-2.500l5 5M15.500 9.500h.01',
  mirror: 'M12 3v18M9 7L4 17h5zM15 7l5 10h-5z',
  skeleton: 'M12 21V10M12 14l-5-5M12 10l4.500-5M7 9V5M7 9H3.500M16.500 5h3M12 17l5-4.500',
  stats: 'M5 20V11M10 20V5M15 20v-7M20 20V8M3 20h18.500',
  picture: 'M4 8h3.500l1.500-2.500h6L16.500 8H20v11H4zM12 10.500a3 3 0 1 1 0 6a3 3 0 0 1 0-6z',
  sun: 'M12 8a4 4 0 1 1 0 8a4 4 0 0 1 0-8zM12 2.500v2.500M12 19v2.500M2.500 12H5M19 12h2.500M5.300 5.300L7 7M17 17l1.700 1.700M5.300 18.700L7 17M17 7l1.700-1.700',
  headset:
    'M4 8h16a1.500 1.500 0 0 1 1.500 1.500v6a1.500 1.500 0 0 1-1.500 1.500h-4.500l-2.300-2.600a1.600 1.600 0 0 0-2.400 0L8.500 17H4a1.500 1.500 0 0 1-1.500-1.500v-6A1.500 1.500 0 0 1 4 8z',
  camera: 'M12 3.500l7.500 4.300v8.400L12 20.500l-7.500-4.300V7.800zM12 9a3 3 0 1 1 0 6a3 3 0 0 1 0-6z',
  light:
    'M5 20c0-7 4-11 14-12-1 9-5 12-10 12-2 0-4-.500-4-2.500M8 17c2-3 4-4.500 7-6M12 2v2.500M5.500 4.500l1.700 1.700M3 11h2.500M18.500 4.500l-1.400 1.400',
  preview:
    'M4 9V5a1 1 0 0 1 1-1h4M15 4h4a1 1 0 0 1 1 1v4M20 15v4a1 1 0 0 1-1 1h-4M9 20H5a1 1 0 0 1-1-1v-4M6.500 12c2-3 3.700-4 5.500-4s3.500 1 5.500 4c-2 3-3.700 4-5.500 4s-3.500-1-5.500-4zM12 10.500a1.500 1.500 0 1 1 0 3a1.500 1.500 0 0 1 0-3z',
  share: 'M14 5h5v5M19 5l-8 8M10 6H6a1 1 0 0 0-1 1v11a1 1 0 0 0 1 1h11a1 1 0 0 0 1-1v-4',
  commands: 'M9 9H7a2 2 0 1 1 2-2v10a2 2 0 1 1-2-2h10a2 2 0 1 1-2 2V7a2 2 0 1 1 2 2z',
  scene: 'M4 18h16M7 18v-5m0 0a3 3 0 1 1 0-6a3 3 0 0 1 0 6zM16.5 18v-8m0 0l-2.500-2.500m2.500 2.500l2.500-3',
  plus: 'M12 5v14M5 12h14',
  up: 'M12 19V6m0 0l-5 5m5-5l5 5',
  pen: 'M4 20l2-6L17 3l4 4L10 18zM14 6l4 4M4 20l4-4',
  layers: 'M12 4l9 5l-9 5l-9-5zM3.500 13L12 17.700L20.500 13M3.500 16.800L12 21.500L20.500 16.800',
  materials:
    'M12 20c-6-3-7-9-4-15c1.500 1.500 2.700 1.500 4 0c1.300 1.500 2.500 1.500 4 0c3 6 2 12-4 15zM12 20V9M12 14l-3-3M12 16l3-3',
  eye: 'M3 12c3-5 6-7 9-7s6 2 9 7c-3 5-6 7-9 7s-6-2-9-7zM12 9.500a2.500 2.500 0 1 1 0 5a2.500 2.500 0 0 1 0-5z',
  hidden:
    'M4 4l16 16M6.500 8C5.2 9 4 10.500 3 12c3 5 6 7 9 7c1.500 0 3-.5 4.500-1.500M10 5.2A8 8 0 0 1 12 5c3 0 6 2 9 7a17 17 0 0 1-2 2.700',
  more: 'M5.500 12h.01M12 12h.01M18.500 12h.01',
  sketch:
    'M4 20l1.200-4.400L16.500 4.300a1.900 1.900 0 0 1 2.700 0l.5.5a1.900 1.900 0 0 1 0 2.700L8.400 18.800z',
  tree: 'M12 21v-8M12 17l-3-2.500M12 15.500l2.500-2M12 3a5 5 0 0 1 4.700 6.700A3.600 3.600 0 0 1 15 16H9a3.600 3.600 0 0 1-1.700-6.300A5 5 0 0 1 12 3z',
  leaf: 'M5 19c-1-9 4-14 14-14c1 10-4 15-14 14zM5 19L14 10M9.500 14.500V11M12 12h3.500',
  flower:
    'M12 9.500a2.500 2.500 0 1 1 0 5a2.500 2.500 0 0 1 0-5zM12 9.500c-2.500-2-2.500-6 0-6.500c2.500.5 2.500 4.500 0 6.500zM14.400 11.300c1.100-3 4.900-4.200 6.200-2c.3 2.500-3.400 4-6.2 2zM13.500 14c3.200 0 5.500 3.200 3.800 5.2c-2.400.7-4.800-2.400-3.800-5.2zM10.500 14c-3.200 0-5.500 3.200-3.800 5.2c2.400.7 4.800-2.400 3.800-5.2zM9.600 11.300c-1.100-3-4.900-4.200-6.200-2c-.3 2.500 3.400 4 6.2 2z',
  play: 'M8 5.500l10 6.500l-10 6.500z',
  warning: 'M12 4l9 16H3zM12 10v4.500M12 17.300h.01',
  translate:
    'M12 3v18M3 12h18M12 3l-2.500 2.500M12 3l2.500 2.500M12 21l-2.500-2.500M12 21l2.500-2.500M3 12l2.500-2.500M3 12l2.500 2.500M21 12l-2.500-2.500M21 12l-2.500 2.500',
  rotate: 'M19.500 12a7.500 7.500 0 1 1-2.200-5.300M18 3v4h-4',
  shape:
    'M6.2 16.2a2.6 2.6 0 1 1 0 5.2a2.6 2.6 0 0 1 0-5.2zM17.8 16.2a2.6 2.6 0 1 1 0 5.2a2.6 2.6 0 0 1 0-5.2zM7.6 16.6L15.500 3M16.4 16.6L8.500 3',
  prune:
    'M6.2 16.2a2.6 2.6 0 1 1 0 5.2a2.6 2.6 0 0 1 0-5.2zM17.8 16.2a2.6 2.6 0 1 1 0 5.2a2.6 2.6 0 0 1 0-5.2zM7.6 16.6L15.500 3M16.4 16.6L8.500 3',
  slide: 'M7 21V3M7 13l8-5M19 5v10M16.500 7.500L19 5l2.500 2.500M16.500 12.500L19 15l2.500-2.500',
  regrow: 'M12 21v-8M12 17l-4-3M5.500 9.500a7 7 0 1 1 3 5M5.500 9.500L4 6M5.500 9.500L9 8.500',
  branch: 'M4 20c6-1 7-6 9-9s4-5 7-6M12 12.500l-1-5M9.500 16.2l5.500.8',
  brush:
    'M20 4c-5 2-9 6-10.500 9M20 4c-1.500 5-5 9-8 11M9.500 13c-3 0-3 3-5.500 6.500c3.500.5 7.500 0 8-4.500z',
  silhouette:
    'M12 3c4 0 7 3 6.500 7c2 2 1 6-2 6h-9c-3 0-4-4-2-6C5 6 8 3 12 3zM12 21v-9M12 15l-2.500-2M12 13.500l2.500-2',
  scale: 'M4 20h7v-7H4zM14 10l6-6M15.500 4H20v4.500',
} as const;

export type IconName = keyof typeof PATHS;

export function icon(name: IconName): SVGSVGElement {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(space, 'path');
  path.setAttribute('d', PATHS[name]);
  svg.append(path);
  return svg;
}

export function button(name: IconName, label: string, act: () => void, key = ''): HTMLButtonElement {
  const b = el('button', { type: 'button', class: 'icon', onclick: act }, icon(name));
  relabel(b, label, key);
  return b;
}

export function relabel(b: HTMLElement, label: string, key = ''): void {
  b.title = key ? `${label}  (${key})` : label;
  b.setAttribute('aria-label', label);
}

const notes = el('div', { class: 'notes', role: 'status', 'aria-live': 'polite' });

let listener: ((text: string) => void) | undefined;

/** Where the page itself is not seen, somebody else says what it notes; undefined: nobody any more. */
export function hearNotes(say: ((text: string) => void) | undefined): void {
  listener = say;
}

/** A line at the foot of the page; bad news stay longer and are told at once. */
export function note(
  text: string,
  tone: 'good' | 'bad' = 'good',
  action?: { label: string; act: () => void },
): void {
  listener?.(text);
  if (!notes.isConnected) document.body.append(notes);
  for (const other of notes.children) if (other.getAttribute('data-text') === text) other.remove();
  const line = el('div', { class: `note ${tone}`, 'data-text': text }, el('span', {}, text));
  if (tone === 'bad') line.setAttribute('role', 'alert');
  const gone = (): void => line.remove();
  if (action)
    line.append(
      el(
        'button',
        {
          type: 'button',
          onclick: () => {
            gone();
            action.act();
          },
        },
        action.label,
      ),
    );
  const close = button('close', t('dialog.close'), gone);
  line.append(close);
  notes.append(line);
  while (notes.children.length > 4) notes.firstElementChild?.remove();
  setTimeout(gone, tone === 'bad' ? 12_000 : 4_500);
}

/** A modal dialog; Escape, the cross and a click beside it close it. */
export function dialog(title: string, ...content: Child[]): HTMLDialogElement {
  const d = el('dialog', { 'aria-label': title });
  const close = button('close', t('dialog.close'), () => d.close());
  d.append(el('header', {}, el('h2', {}, title), close), ...content);
  d.addEventListener('close', () => d.remove());
  d.addEventListener('click', (e) => {
    if (e.target === d) d.close();
  });
  document.body.append(d);
  d.showModal();
  return d;
}

/** Asks for a name, beginning with one; nothing happens where none is given. */
export function askName(title: string, label: string, now: string, act: (name: string) => void): void {
  const field = el('input', { class: 'field', maxlength: '200', 'aria-label': label });
  field.value = now;
  const submit = (e: Event): void => {
    e.preventDefault();
    d.close();
    const name = field.value.trim();
    if (name) act(name);
  };
  const go = el('button', { type: 'submit', class: 'primary' }, title);
  const row = el('div', { class: 'row' }, el('span', { class: 'space' }), go);
  const d = dialog(title, el('form', { onsubmit: submit }, field, row));
  field.select();
}

/** A panel below a button; it closes when something else is used. */
export function popover(anchor: HTMLElement, content: HTMLElement, label: string): void {
  const open = document.querySelector('.popover');
  const mine = open?.getAttribute('data-for') === anchor.id && anchor.id !== '';
  closePopover();
  if (mine) return;
  const p = el(
    'div',
    { class: 'popover', role: 'dialog', 'aria-label': label, 'data-for': anchor.id },
    content,
  );
  document.body.append(p);
  // Below the button, or beside it where there is no room below; its content may change.
  const place = (): void => {
    const box = anchor.getBoundingClientRect();
    const [w, h] = [p.offsetWidth, p.offsetHeight];
    // Beside a column of tools, so that it covers none.
    const tools = anchor.closest('[role=toolbar]')?.getBoundingClientRect();
    if (tools && tools.height > tools.width) {
      const right = tools.right + 8 + w <= innerWidth - 8 ? tools.right + 8 : tools.left - 8 - w;
      if (right >= 8) {
        p.style.top = `${Math.max(8, Math.min(box.top, innerHeight - h - 8))}px`;
        p.style.left = `${right}px`;
        return;
      }
    }
    const below = box.bottom + 6 + h <= innerHeight - 8;
    const beside = !below && box.left - w - 8 >= 8;
    // At the foot of the page it stands above its button.
    const foot = !below && !beside && box.top - h - 6 >= 8;
    const left = beside ? box.left - w - 8 : box.left;
    const top = below ? box.bottom + 6 : foot ? box.top - h - 6 : Math.max(8, innerHeight - h - 8);
    p.style.top = `${top}px`;
    p.style.left = `${Math.max(8, Math.min(left, innerWidth - w - 8))}px`;
  };
  place();
  new ResizeObserver(place).observe(p);
  anchor.setAttribute('aria-expanded', 'true');
  p.querySelector<HTMLElement>('button, input, select')?.focus();
  const away = (e: Event): void => {
    if (
      e instanceof KeyboardEvent
        ? e.key === 'Escape'
        : !p.contains(e.target as Node) && !anchor.contains(e.target as Node)
    ) {
      closePopover();
      if (e instanceof KeyboardEvent) anchor.focus();
    }
  };
  document.addEventListener('pointerdown', away, true);
  document.addEventListener('keydown', away, true);
  cleanup = () => {
    document.removeEventListener('pointerdown', away, true);
    document.removeEventListener('keydown', away, true);
    anchor.setAttribute('aria-expanded', 'false');
    p.remove();
  };
}

let cleanup: (() => void) | undefined;

export function closePopover(): void {
  cleanup?.();
  cleanup = undefined;
}

/** Gives a file to the person. */
export function download(name: string, bytes: BlobPart, type: string): void {
  const url = URL.createObjectURL(new Blob([bytes], { type }));
  const a = el('a', { href: url, download: name });
  document.body.append(a);
  a.click();
  a.remove();
  setTimeout(() => URL.revokeObjectURL(url), 30_000);
}
