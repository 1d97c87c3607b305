// BSDFs and textures to scene.materials and scene.textures.
#pragma once

#include "engine/load/parameters.h"

namespace wavecrest {

// Index of the material of a <bsdf> (read once however often it is referenced).
uint32_t materialOf(LoadContext& context, const XmlElement& bsdf);
// What a shape without a BSDF has: Mitsuba's `diffuse` of reflectance 0.5, and 0 on a light.
uint32_t defaultMaterial(LoadContext& context, bool isLight);

uint32_t textureOf(LoadContext& context, const XmlElement& texture);
// The same without a place in the scene, for textures that are made of it.
Texture readTexture(LoadContext& context, const XmlElement& texture);
// textureOf for a light, whose values may not be negative. where: what refers to the texture.
uint32_t emissionTextureOf(LoadContext& context, const XmlElement& texture, const SourceLocation& where);

// A parameter that is a colour or a texture; TexturedRgb::texture says which.
TexturedRgb readTexturedRgb(LoadContext& context, Parameters& parameters, std::string_view name, double fallback);
TexturedRgb readTexturedEmission(LoadContext& context, Parameters& parameters, std::string_view name);
// The texture that stands in for another where a number is asked for instead of a colour. asMitsuba3: a bitmap gives
// luminances, and a checkerboard's colours are exchanged; otherwise a bitmap gives means, as in Mitsuba 0.6.
uint32_t scalarTextureOf(LoadContext& context, uint32_t index, bool asMitsuba3);
Texture scalarTexture(Texture texture, bool asMitsuba3);

TexturedFloat readTexturedFloat(LoadContext& context, Parameters& parameters, std::string_view name, double fallback);
// Whether the colour or the texture that a number is read from is anywhere not grey.
bool isColored(LoadContext& context, Parameters& parameters, std::string_view name);
// A parameter that must be one colour everywhere.
Rgb readConstantEmission(LoadContext& context, Parameters& parameters, std::string_view name);

// Reads a nested <bsdf> into `material`, for the adapters (twosided, mask, bumpmap, normalmap).
void readBsdf(LoadContext& context, const XmlElement& bsdf, Material& material);

}  // namespace wavecrest
