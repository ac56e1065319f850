// The preferences that the page remembers: theme and view. `hedon view` uses a different port each time, and only
// cookies are shared by all ports.

const DAYS = 365;

export function remember(name: string, value: string): void {
  document.cookie = `hedon-${name}=${encodeURIComponent(value)}; path=/; max-age=${DAYS * 86400}; samesite=strict`;
}

export function recall(name: string): string | undefined {
  const cookie = document.cookie.split("; ").find((each) => each.startsWith(`hedon-${name}=`));
  return cookie && decodeURIComponent(cookie.slice(cookie.indexOf("=") + 1));
}

/** Restores the last theme: dark, light, or the system's. */
export function recallTheme(): void {
  const theme = recall("theme");
  if (theme === "dark" || theme === "light") document.documentElement.dataset.theme = theme;
}

export function switchTheme(): void {
  const dark = getComputedStyle(document.documentElement).colorScheme.startsWith("dark");
  remember("theme", (document.documentElement.dataset.theme = dark ? "light" : "dark"));
}
