// Short functions that create elements.

type Attributes = Record<string, string | boolean | ((event: never) => void)>;

/** Creates an element; attributes that are functions become listeners ("onclick"). */
export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') {
      made.addEventListener(name.slice(2), value as unknown as EventListener);
    } else if (value !== false) {
      made.setAttribute(name, value === true ? '' : value);
    }
  }
  made.append(...children);
  return made;
}

export function button(label: string, title: string, onclick: () => void): HTMLButtonElement {
  return element('button', { type: 'button', title, 'aria-label': title, onclick }, label);
}

/** Offers a file to the user as a download. */
export function download(name: string, content: Blob): void {
  const link = element('a', { href: URL.createObjectURL(content), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
