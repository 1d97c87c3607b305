// BSDFs: the defaults of every plugin, its parameters, the adapters around it, and what is refused. Sums of BSDFs:
// blend_test.cpp.
#include "tests/load/bsdf_scene.h"

namespace wavecrest {
namespace {

constexpr Rgb kWhite{1, 1, 1}, kHalf{0.5, 0.5, 0.5};

TEST(Bsdf, DiffuseDefaults) { EXPECT_EQ(kindOf<Diffuse>(R"(<bsdf type="diffuse"/>)").reflectance.value, kHalf); }

TEST(Bsdf, ShapeWithoutOneIsDiffuse) {
  EXPECT_EQ(std::get<Diffuse>(loadBody("").materials.at(0).kind).reflectance.value, kHalf);
}

TEST(Bsdf, LightWithoutOneIsBlack) {
  const Scene scene = loadBody(R"(<shape type="sphere"><emitter type="area"/></shape>)");
  EXPECT_EQ(std::get<Diffuse>(scene.materials.at(0).kind).reflectance.value, (Rgb{0, 0, 0}));
}

TEST(Bsdf, ConductorDefaultsToAPerfectMirror) {
  const Conductor conductor = kindOf<Conductor>(R"(<bsdf type="conductor"/>)");
  EXPECT_TRUE(conductor.perfectMirror);
  EXPECT_EQ(conductor.specularReflectance.value, kWhite);
  EXPECT_EQ(conductor.alpha.value, 0);
}

// Mitsuba 0.6: copper in air, whose constants single parameters replace.
TEST(Bsdf, ConductorOfOldFilesDefaultsToCopper) {
  const auto conductorOf = [](const std::string& version, const std::string& type, const std::string& content) {
    const Scene scene = load(sceneXml(
        "<shape type=\"sphere\"><bsdf type=\"" + type + "\">" + content + "</bsdf></shape>" + std::string(kSensor),
        version));
    return std::get<Conductor>(scene.materials.at(0).kind);
  };
  const Conductor copper = conductorOf("3.0.0", "conductor", R"(<string name="material" value="Cu"/>)");
  const auto inAir = [](double index) { return index / 1.000277; };
  for (const char* type : {"conductor", "roughconductor"}) {
    const Conductor old = conductorOf("0.6.0", type, "");
    const Conductor ofEta = conductorOf("0.6.0", type, R"(<spectrum name="eta" value="2"/>)");
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(old.eta[c], inAir(copper.eta[c]), 1e-12);
      EXPECT_NEAR(old.k[c], inAir(copper.k[c]), 1e-12);
      EXPECT_NEAR(ofEta.eta[c], inAir(2), 1e-12);
      EXPECT_NEAR(ofEta.k[c], inAir(copper.k[c]), 1e-12);
    }
  }
  EXPECT_TRUE(conductorOf("0.6.0", "conductor", R"(<string name="material" value="none"/>)").perfectMirror);
}

TEST(Bsdf, LenientReplacesThoseOfOldFilesByTheNearest) {
  const auto scene = [](const std::string& bsdf) {
    return loadBody("<shape type=\"sphere\">" + bsdf + "</shape>", {.lenient = true});
  };
  const Scene rough = scene(
      R"(<bsdf type="roughdiffuse"><float name="alpha" value="0.3"/><rgb name="reflectance" value="0.2"/></bsdf>)");
  EXPECT_EQ(std::get<Diffuse>(rough.materials.at(0).kind).reflectance.value, (Rgb{0.2, 0.2, 0.2}));
  EXPECT_EQ(rough.warnings.size(), 1u);
  const Scene ward =
      scene(R"(<bsdf type="ward"><float name="alpha_u" value="0.2"/><float name="alpha_v" value="0.1"/></bsdf>)");
  EXPECT_NEAR(std::get<Phong>(ward.materials.at(0).kind).exponent, 100, 1e-9);
  // Without roughness it is diffuse.
  EXPECT_TRUE(scene(R"(<bsdf type="roughdiffuse"><float name="alpha" value="0"/></bsdf>)").warnings.empty());
}

TEST(Bsdf, ConductorMaterialNoneIsAPerfectMirror) {
  EXPECT_TRUE(
      kindOf<Conductor>(R"(<bsdf type="conductor"><string name="material" value="none"/></bsdf>)").perfectMirror);
}

// Mitsuba 3.9, scalar_rgb.
TEST(Bsdf, ConductorOfNamedMaterialHasMitsubasConstants) {
  const Conductor gold = kindOf<Conductor>(R"(<bsdf type="conductor"><string name="material" value="Au"/></bsdf>)");
  EXPECT_EQ(gold.eta, (Rgb{0.143036, 0.375307, 1.44205}));
  EXPECT_EQ(gold.k, (Rgb{3.983, 2.38556, 1.60336}));
  EXPECT_FALSE(gold.perfectMirror);
}

TEST(Bsdf, ConductorTakesEtaAndK) {
  const Conductor conductor =
      kindOf<Conductor>(R"(<bsdf type="conductor"><rgb name="eta" value="1,2,3"/><float name="k" value="4"/></bsdf>)");
  EXPECT_EQ(conductor.eta, (Rgb{1, 2, 3}));
  EXPECT_EQ(conductor.k, (Rgb{4, 4, 4}));
}

// Of Mitsuba 0.6: light comes from a medium that has an index too.
TEST(Bsdf, ConductorDividesByExtEta) {
  const auto conductorIn = [](const std::string& outside) {
    return kindOf<Conductor>(
        R"(<bsdf type="conductor"><rgb name="eta" value="1.5,3,6"/><rgb name="k" value="3,6,9"/>)" + outside +
        "</bsdf>");
  };
  EXPECT_EQ(conductorIn(R"(<float name="ext_eta" value="1.5"/>)").eta, (Rgb{1, 2, 4}));
  EXPECT_EQ(conductorIn(R"(<float name="ext_eta" value="1.5"/>)").k, (Rgb{2, 4, 6}));
  EXPECT_EQ(conductorIn(R"(<string name="ext_eta" value="vacuum"/>)").eta, (Rgb{1.5, 3, 6}));
  EXPECT_NEAR(conductorIn(R"(<string name="ext_eta" value="water"/>)").eta[0], 1.5 / 1.333, 1e-12);
}

TEST(Bsdf, ConductorEtaSlightlyBelow0Is0WithANote) {
  const auto sceneOf = [](const std::string& eta) {
    return loadBody(R"(<shape type="sphere"><bsdf type="conductor"><rgb name="eta" value=")" + eta +
                    R"("/><float name="k" value="3"/></bsdf></shape>)");
  };
  const Scene scene = sceneOf("0.2,-0.01,0.3");
  EXPECT_EQ(std::get<Conductor>(scene.materials.at(0).kind).eta, (Rgb{0.2, 0, 0.3}));
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].what.find("below 0"), std::string::npos);
  EXPECT_THROW(sceneOf("0.2,-1,0.3"), LoadError);
}

TEST(Bsdf, NullLetsEverythingThrough) { EXPECT_EQ(materialOf(R"(<bsdf type="null"/>)").opacity->value, 0); }

TEST(Bsdf, RoughConductorDefaults) {
  const Conductor conductor = kindOf<Conductor>(R"(<bsdf type="roughconductor"/>)");
  EXPECT_EQ(conductor.alpha.value, 0.1);
  EXPECT_EQ(conductor.distribution, Distribution::beckmann);
  EXPECT_TRUE(conductor.perfectMirror);
}

TEST(Bsdf, RoughConductorTakesDistributionAndAlpha) {
  const Conductor conductor = kindOf<Conductor>(R"(<bsdf type="roughconductor">
      <string name="distribution" value="GGX"/><float name="alpha" value="0.3"/></bsdf>)");
  EXPECT_EQ(conductor.distribution, Distribution::ggx);
  EXPECT_EQ(conductor.alpha.value, 0.3);
}

TEST(Bsdf, RoughnessOfZeroStaysRough) {
  EXPECT_EQ(kindOf<Conductor>(R"(<bsdf type="roughconductor"><float name="alpha" value="0"/></bsdf>)").alpha.value,
            1e-4);
}

TEST(Bsdf, EqualAlphaUAndAlphaVAreAlpha) {
  EXPECT_EQ(kindOf<Conductor>(R"(<bsdf type="roughconductor"><float name="alpha_u" value="0.2"/>
      <float name="alpha_v" value="0.2"/></bsdf>)")
                .alpha.value,
            0.2);
}

TEST(Bsdf, RoughnessCanBeATexture) {
  EXPECT_EQ(kindOf<Conductor>(R"(<bsdf type="roughconductor"><texture type="checkerboard" name="alpha"/></bsdf>)")
                .alpha.texture,
            1u);
}

TEST(Bsdf, DielectricDefaults) {
  const Dielectric glass = kindOf<Dielectric>(R"(<bsdf type="dielectric"/>)");
  EXPECT_EQ(glass.intIor, 1.5046);
  EXPECT_EQ(glass.extIor, 1.000277);
  EXPECT_EQ(glass.specularReflectance.value, kWhite);
  EXPECT_EQ(glass.specularTransmittance.value, kWhite);
  EXPECT_EQ(glass.alpha.value, 0);
  EXPECT_FALSE(glass.thin);
}

TEST(Bsdf, IndexOfRefractionByNameIgnoresCase) {
  const Dielectric glass = kindOf<Dielectric>(R"(<bsdf type="dielectric"><string name="int_ior" value="Water Ice"/>
      <string name="ext_ior" value="vacuum"/></bsdf>)");
  EXPECT_EQ(glass.intIor, 1.31);
  EXPECT_EQ(glass.extIor, 1);
}

TEST(Bsdf, ThinDielectricIsThin) { EXPECT_TRUE(kindOf<Dielectric>(R"(<bsdf type="thindielectric"/>)").thin); }

TEST(Bsdf, RoughDielectricDefaults) {
  const Dielectric glass = kindOf<Dielectric>(R"(<bsdf type="roughdielectric"/>)");
  EXPECT_EQ(glass.intIor, 1.5046);
  EXPECT_EQ(glass.alpha.value, 0.1);
  EXPECT_EQ(glass.distribution, Distribution::beckmann);
}

TEST(Bsdf, PlasticDefaults) {
  const Plastic plastic = kindOf<Plastic>(R"(<bsdf type="plastic"/>)");
  EXPECT_EQ(plastic.intIor, 1.49);
  EXPECT_EQ(plastic.extIor, 1.000277);
  EXPECT_EQ(plastic.diffuseReflectance.value, kHalf);
  EXPECT_EQ(plastic.specularReflectance.value, kWhite);
  EXPECT_EQ(plastic.alpha.value, 0);
  EXPECT_FALSE(plastic.nonlinear);
}

TEST(Bsdf, RoughPlasticDefaults) {
  const Plastic plastic = kindOf<Plastic>(R"(<bsdf type="roughplastic"/>)");
  EXPECT_EQ(plastic.alpha.value, 0.1);
  EXPECT_EQ(plastic.distribution, Distribution::beckmann);
}

TEST(Bsdf, PhongDefaults) {
  const Phong phong = kindOf<Phong>(R"(<bsdf type="phong"/>)");
  EXPECT_EQ(phong.diffuseReflectance.value, kHalf);
  EXPECT_EQ(phong.specularReflectance.value, (Rgb{0.2, 0.2, 0.2}));
  EXPECT_EQ(phong.exponent, 30);
}

TEST(Bsdf, MaterialIsOneSidedUnlessToldOtherwise) {
  EXPECT_FALSE(materialOf(R"(<bsdf type="diffuse"/>)").twoSided);
  EXPECT_TRUE(materialOf(R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)").twoSided);
}

TEST(Bsdf, MaskHasOpacityOfOneHalf) {
  const Material material = materialOf(R"(<bsdf type="mask"><bsdf type="conductor"/></bsdf>)");
  ASSERT_TRUE(material.opacity.has_value());
  EXPECT_EQ(material.opacity->value, 0.5);
  EXPECT_TRUE(std::holds_alternative<Conductor>(material.kind));
}

TEST(Bsdf, MaskAroundTwoSidedKeepsBoth) {
  const Material material = materialOf(R"(<bsdf type="mask"><float name="opacity" value="0.25"/>
      <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf>)");
  EXPECT_TRUE(material.twoSided);
  EXPECT_EQ(material.opacity->value, 0.25);
}

TEST(Bsdf, BumpMapTakesTextureAndScale) {
  const Material material = materialOf(R"(<bsdf type="bumpmap"><float name="scale" value="3"/>
      <texture type="checkerboard"/><bsdf type="diffuse"/></bsdf>)");
  EXPECT_EQ(material.bumpTexture, 1u);
  EXPECT_EQ(material.bumpScale, 3);
}

TEST(Bsdf, BumpsOfWhatHasNoSlopesAreNoted) {
  const Scene scene = loadBody(R"(<shape type="sphere"><bsdf type="bumpmap"><texture type="checkerboard"/>
      <bsdf type="diffuse"/></bsdf></shape>)");
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].effect.find("no bumps"), std::string::npos);
}

TEST(Bsdf, MapsFlipNormalsAndSoftenShadowsUnlessToldOtherwise) {
  const auto mappingOf = [](const std::string& parameter, std::string_view version = "3.0.0") {
    const std::string bsdf =
        R"(<bsdf type="bumpmap">)" + parameter + R"(<texture type="checkerboard"/><bsdf type="diffuse"/></bsdf>)";
    return load(sceneXml("<shape type=\"sphere\">" + bsdf + "</shape>" + std::string(kSensor), version))
        .materials.at(0)
        .normalMapping;
  };
  EXPECT_TRUE(mappingOf("").flipInvalidNormals);
  EXPECT_TRUE(mappingOf("").shadowing);
  const NormalMapping unflipped = mappingOf(R"(<boolean name="flip_invalid_normals" value="false"/>)");
  EXPECT_FALSE(unflipped.flipInvalidNormals);
  EXPECT_TRUE(unflipped.shadowing);
  const NormalMapping hard = mappingOf(R"(<boolean name="use_shadowing_function" value="false"/>)");
  EXPECT_TRUE(hard.flipInvalidNormals);
  EXPECT_FALSE(hard.shadowing);
  // Mitsuba 0.6 evaluates the nested BSDF in the mapped frame, and does nothing else.
  const NormalMapping old = mappingOf("", "0.6.0");
  EXPECT_FALSE(old.flipInvalidNormals);
  EXPECT_FALSE(old.shadowing);
}

TEST(Bsdf, MapsOfOldFilesHaveTheirOldNames) {
  const auto materialOfOld = [](const std::string& bsdf, std::string_view version) {
    return load(sceneXml("<shape type=\"sphere\">" + bsdf + "</shape>" + std::string(kSensor), version))
        .materials.at(0);
  };
  const std::string inner = R"(<texture type="checkerboard"/><bsdf type="diffuse"/></bsdf>)";
  EXPECT_EQ(materialOfOld(R"(<bsdf type="normalmap">)" + inner, "0.6.0").normalTexture, 0u);
  EXPECT_NE(materialOfOld(R"(<bsdf type="bump">)" + inner, "0.4.0").bumpTexture, kNone);
  expectBsdfError(R"(<bsdf type="bump">)" + inner, "bsdf \"bump\" is not supported");
}

TEST(Bsdf, MapsKnowWhetherTwoSidednessIsAroundThem) {
  const std::string map = R"(<bsdf type="normalmap"><texture type="checkerboard" name="normalmap"/>)";
  const Material within = materialOf(R"(<bsdf type="twosided">)" + map + R"(<bsdf type="diffuse"/></bsdf></bsdf>)");
  EXPECT_TRUE(within.twoSided);
  EXPECT_FALSE(within.normalMapping.aroundTwoSided);
  const Material around = materialOf(map + R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf>)");
  EXPECT_TRUE(around.twoSided);
  EXPECT_TRUE(around.normalMapping.aroundTwoSided);
  const Material both = materialOf(R"(<bsdf type="twosided">)" + map +
                                   R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf></bsdf>)");
  EXPECT_TRUE(both.twoSided);
  EXPECT_FALSE(both.normalMapping.aroundTwoSided);
}

TEST(Bsdf, NormalMapTakesItsTexture) {
  const Material material = materialOf(R"(<bsdf type="normalmap"><texture type="checkerboard" name="normalmap"/>
      <bsdf type="diffuse"/></bsdf>)");
  EXPECT_EQ(material.normalTexture, 0u);
}

TEST(Bsdf, TwoRoughnessesAreKeptWhereTheyDiffer) {
  const std::string text = R"(<float name="alpha_u" value="0.3"/><float name="alpha_v" value="0.1"/>)";
  const Conductor metal = kindOf<Conductor>("<bsdf type=\"roughconductor\">" + text + "</bsdf>");
  EXPECT_EQ(metal.alpha.value, 0.3);
  EXPECT_EQ(metal.alphaV.value().value, 0.1);
  EXPECT_EQ(kindOf<Dielectric>("<bsdf type=\"roughdielectric\">" + text + "</bsdf>").alphaV.value().value, 0.1);
}

// Each is at most 1 before it counts.
TEST(Bsdf, MasksWithinEachOtherMultiply) {
  const auto opacityOf = [](const std::string& outer, const std::string& inner) {
    return materialOf(R"(<bsdf type="mask"><float name="opacity" value=")" + outer +
                      R"("/><bsdf type="mask"><float name="opacity" value=")" + inner +
                      R"("/><bsdf type="diffuse"/></bsdf></bsdf>)")
        .opacity.value()
        .value;
  };
  EXPECT_EQ(opacityOf("0.5", "0.25"), 0.125);
  EXPECT_EQ(opacityOf("2", "0.25"), 0.25);
  EXPECT_EQ(opacityOf("0.25", "2"), 0.25);
}

TEST(Bsdf, PrincipledDefaultsAndIndex) {
  const Principled plain = kindOf<Principled>(R"(<bsdf type="principled"/>)");
  EXPECT_EQ(plain.baseColor.value, kHalf);
  EXPECT_EQ(plain.roughness.value, 0.5);
  EXPECT_NEAR(plain.eta, 1.5, 1e-12);  // of specular 0.5
  EXPECT_FALSE(plain.thin);
  // Glass without a change of index would not bend light: Mitsuba moves it off 1.
  EXPECT_EQ(kindOf<Principled>(R"(<bsdf type="principled"><float name="eta" value="1"/>
      <float name="spec_trans" value="1"/></bsdf>)")
                .eta,
            1.001);
  const Principled sheet =
      kindOf<Principled>(R"(<bsdf type="principledthin"><float name="diff_trans" value="2"/></bsdf>)");
  EXPECT_TRUE(sheet.thin);
  EXPECT_EQ(sheet.diffTrans.value, 2);
  expectBsdfError(R"(<bsdf type="principled"><float name="eta" value="1.2"/><float name="specular" value="1"/></bsdf>)",
                  "one of the two");
  expectBsdfError(R"(<bsdf type="principledthin"><float name="metallic" value="1"/></bsdf>)", "metallic");
}

TEST(Bsdf, ParametersOfPrincipledHaveTheirRanges) {
  const auto bsdf = [](const std::string& type, const std::string& name, const std::string& value) {
    return "<bsdf type=\"" + type + "\"><float name=\"" + name + "\" value=\"" + value + "\"/></bsdf>";
  };
  for (const std::string name : {"anisotropic", "spec_trans", "spec_tint", "sheen", "sheen_tint", "flatness",
                                 "metallic", "clearcoat", "clearcoat_gloss"}) {
    EXPECT_NO_THROW(materialOf(bsdf("principled", name, "1"))) << name;
    expectBsdfError(bsdf("principled", name, "1.5"), name + " is outside of its range; expected 0 to 1");
  }
  expectBsdfError(bsdf("principledthin", "diff_trans", "5"), "diff_trans is outside of its range; expected 0 to 2");
  EXPECT_EQ(kindOf<Principled>(bsdf("principled", "roughness", "1.5")).roughness.value, 1.5);
}

TEST(Bsdf, MistakesAreErrors) {
  expectBsdfError(R"(<bsdf type="ward"/>)",
                  "bsdf \"ward\" of Mitsuba 0.6 is not supported; expected a bsdf \"phong\" of the same reflectances "
                  "and of exponent 200, the nearest");
  expectBsdfError(R"(<bsdf type="roughdiffuse"/>)",
                  "bsdf \"roughdiffuse\" of Mitsuba 0.6 is not supported; expected a bsdf \"diffuse\"");
  expectBsdfError(R"(<bsdf type="roughconductor"><string name="distribution" value="phong"/></bsdf>)",
                  "distribution \"phong\" of Mitsuba 0.6 is not supported; expected beckmann of the same alpha");
  expectBsdfError(R"(<bsdf type="conductor"><string name="material" value="Xx"/></bsdf>)", "unknown conductor \"Xx\"");
  expectBsdfError(R"(<bsdf type="conductor"><string name="material" value="Al"/><rgb name="k" value="1"/></bsdf>)",
                  "eta and k stand beside a material");
  expectBsdfError(R"(<bsdf type="dielectric"><string name="int_ior" value="mud"/></bsdf>)",
                  "unknown substance \"mud\"");
  expectBsdfError(R"(<bsdf type="dielectric"><float name="int_ior" value="0"/></bsdf>)", "not positive");
  expectBsdfError(R"(<bsdf type="roughconductor"><string name="distribution" value="cosine"/></bsdf>)",
                  "unknown distribution");
  expectBsdfError(R"(<bsdf type="roughconductor"><float name="alpha_u" value="1"/></bsdf>)", "alpha_u and alpha_v");
  expectBsdfError(
      R"(<bsdf type="roughplastic"><float name="alpha_u" value="1"/><float name="alpha_v" value="0.5"/></bsdf>)",
      "is isotropic");
  expectBsdfError(R"(<bsdf type="roughplastic"><texture type="checkerboard" name="alpha"/></bsdf>)", "is a texture");
  expectBsdfError(R"(<bsdf type="twosided"/>)", "contains 0 objects <bsdf>");
  expectBsdfError(R"(<bsdf type="twosided"><bsdf type="dielectric"/></bsdf>)", "BSDF that transmits");
  expectBsdfError(R"(<bsdf type="twosided"><bsdf type="diffuse"/><bsdf type="conductor"/></bsdf>)",
                  "two different BSDFs");
  expectBsdfError(R"(<bsdf type="mask"><bsdf type="mask"><texture type="checkerboard" name="opacity"/>
      <bsdf type="diffuse"/></bsdf></bsdf>)",
                  "nested in another");
  expectBsdfError(R"(<bsdf type="bumpmap"><bsdf type="diffuse"/></bsdf>)", "contains 0 objects <texture>");
  expectBsdfError(R"(<bsdf type="normalmap"><texture type="checkerboard"/><bsdf type="diffuse"/></bsdf>)",
                  "name=\"normalmap\"");
  expectBsdfError(R"(<bsdf type="diffuse"/><bsdf type="diffuse"/>)", "contains 2 objects <bsdf>");
}

TEST(Bsdf, LenientGoesOnWithTheMeanOfATextureAndTheInnerOfTwoAdapters) {
  const auto sceneOf = [](const std::string& bsdf) {
    Scene scene = loadBody("<shape type=\"sphere\">" + bsdf + "</shape>", {.lenient = true});
    EXPECT_EQ(scene.warnings.size(), 1u) << bsdf;
    return scene;
  };
  // The colours of a checkerboard are 0.4 and 0.2.
  const auto textured = [&](const std::string& type, const std::string& name) {
    return sceneOf("<bsdf type=\"" + type + R"("><texture type="checkerboard" name=")" + name + "\"/></bsdf>");
  };
  const TexturedFloat alpha = std::get<Plastic>(textured("roughplastic", "alpha").materials.at(0).kind).alpha;
  EXPECT_NEAR(alpha.value, 0.3, 1e-12);
  EXPECT_EQ(alpha.texture, kNone);
  EXPECT_NEAR(std::get<Phong>(textured("phong", "exponent").materials.at(0).kind).exponent, 0.3, 1e-12);
  const auto mask = [](const std::string& opacity, const std::string& inner) {
    return R"(<bsdf type="mask">)" + opacity + inner + "</bsdf>";
  };
  const std::string inner = mask(R"(<float name="opacity" value="0.25"/>)", R"(<bsdf type="diffuse"/>)");
  const Scene masked = sceneOf(mask(R"(<texture type="checkerboard" name="opacity"/>)", inner));
  EXPECT_EQ(masked.materials.at(0).opacity.value().value, 0.25);
  const auto map = [](const std::string& scale, const std::string& nested) {
    return R"(<bsdf type="bumpmap"><texture type="checkerboard"/><float name="scale" value=")" + scale + "\"/>" +
           nested + "</bsdf>";
  };
  EXPECT_EQ(sceneOf(map("2", map("3", R"(<bsdf type="diffuse"/>)"))).materials.at(0).bumpScale, 3);
}

}  // namespace
}  // namespace wavecrest
