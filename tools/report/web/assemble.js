// node assemble.js TEMPLATE BUNDLE PAGE: puts BUNDLE.js and BUNDLE.css into the template.
import {readFileSync, writeFileSync} from 'node:fs';

const [template, bundle, page] = process.argv.slice(2);
const text = file => readFileSync(file, 'utf8');
const script = text(`${bundle}.js`).replaceAll('</script', '<\\/script');
writeFileSync(page, text(template)
    .replace('/* style */', () => text(`${bundle}.css`))
    .replace('/* script */', () => script));
