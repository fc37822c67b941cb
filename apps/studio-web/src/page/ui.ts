/** Small pieces of the page: elements, icons, notes, dialogs. */
import { type IconName, pathOf } from './icons';
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

export function icon(name: IconName): SVGSVGElement {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(space, 'path');
  path.setAttribute('d', pathOf(name));
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
