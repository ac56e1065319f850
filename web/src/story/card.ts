// A picture of the contest's result, for sharing: a headline and a line about the creatures above the arena and the map.
import { save } from "../csv";
import { styleColor } from "../element";

const [WIDTH, HEIGHT] = [1200, 630]; // the size at which other sites preview links
const EDGE = 40;
const TOP = 166; // y of the pictures, below the headline and the line after it

export function saveResult(headline: string, about: string, pictures: HTMLCanvasElement[]): void {
  const card = document.createElement("canvas");
  [card.width, card.height] = [WIDTH, HEIGHT];
  const ink = card.getContext("2d")!;
  ink.fillStyle = styleColor("--page");
  ink.fillRect(0, 0, WIDTH, HEIGHT);
  ink.fillStyle = styleColor("--ink");
  ink.font = "600 64px Fraunces, Georgia, serif";
  ink.fillText(headline, EDGE, 90);
  ink.font = "24px system-ui, sans-serif";
  ink.fillText(about, EDGE, 134);
  const open = location.protocol === "https:"; // others can open neither a file nor a server on this computer
  ink.fillText(`Where do rewards come from? ${open ? location.host + location.pathname : ""}`, EDGE, HEIGHT - 24);
  const width = (WIDTH - EDGE * (pictures.length + 1)) / pictures.length;
  pictures.forEach((picture, i) => {
    const scale = Math.min(width / picture.width, (HEIGHT - TOP - 70) / picture.height);
    ink.drawImage(picture, EDGE + i * (width + EDGE), TOP, picture.width * scale, picture.height * scale);
  });
  card.toBlob((blob) => blob && save("beat-evolution.png", blob));
}
