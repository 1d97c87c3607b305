// Renders a built-in scene in two steps, writes the image and compares it with itself; then asks for a scene that is
// not there, and for the name of a state. Prints what it finds, line by line, for install_test.py.
#include <wavecrest/wavecrest.h>
#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  namespace wc = wavecrest::api;

  const wc::Scene scene = wc::Scene::load("cornell-mirror", {.width = 32, .spp = 4});
  wc::Render render(scene, {.method = "vcm", .seed = 7, .threads = 2});
  render.runUntil(std::nullopt, 2);
  const wc::Image early = render.image();
  std::printf("iterations %llu\n", static_cast<unsigned long long>(render.iterations()));
  render.run();
  render.write(argv[1]);

  const wc::Image image = wc::readImage(argv[1]);
  const wc::Reference reference(image);
  std::printf("size %u x %u\n", image.width, image.height);
  std::printf("same as rendered %d\n", image.pixels == render.image().pixels);
  std::printf("rmse to itself %g\n", reference.compare(image, {"rmse"}).results.front().score);
  std::printf("early image differs %d\n", reference.compare(early, {"rmse"}).results.front().score > 0);

  try {
    wc::Scene::load("no-such-scene.xml");
  } catch (const wc::Error& error) {
    std::printf("error in %s, input %d\n", error.file().c_str(), error.kind() == wc::ErrorKind::input);
  }
  std::printf("run %s\n", std::string(toString(wavecrest::RunState::refused)).c_str());
}
