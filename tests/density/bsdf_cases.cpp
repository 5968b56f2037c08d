#include "bsdf_cases.h"

namespace keyhole::test {
namespace {

const ComplexIndex kGold{Rgb(0.14, 0.37, 1.44), Rgb(3.98, 2.38, 1.60)};
/// Reflects all but 1e-4.
const ComplexIndex kWhite{Rgb(1.0), Rgb(200.0)};

PrincipledParameters principled(double metallic, double alpha) {
    PrincipledParameters p;
    p.base_color = Rgb(1.0);
    p.metallic = metallic;
    p.alpha_x = p.alpha_y = alpha;
    return p;
}

void add_principled(std::vector<BsdfCase>& c) {
    const auto add = [&](const char* name, const PrincipledParameters& p, double most_weight, bool all_comes_back,
                         bool draws_always = false) {
        c.push_back(
            {std::string("principled_") + name, PrincipledBsdf(p), 1, all_comes_back, draws_always, most_weight});
    };
    add("default", principled(0, 0.25), 3, true);
    add("smooth", principled(0, 0), 3, true, true);
    add("rough", principled(0, 1), 3, true);
    add("metal", principled(1, 0.25), 12, true);
    add("metal_rough", principled(1, 1), 3, true);
    add("metal_smooth", principled(1, 0), 1.02, true, true);
    add("half_metal", principled(0.5, 0.36), 6, true);
    PrincipledParameters p = principled(0, 0.25);
    p.coat = 1;
    add("coated", p, 3, true);
    p.coat_alpha = 0.3;
    p.base_color = Rgb(0.8, 0.3, 0.05);
    p.metallic = 0.3;
    p.specular_tint = 0.7;
    p.alpha_x = 0.1;
    p.alpha_y = 0.5;
    add("anisotropic", p, 6, false);
    p.sheen = 1;
    p.sheen_tint = 0.5;
    add("everything", p, 6, false);
    p.metallic = 0;
    p.base_color = Rgb(0.0);
    add("black_cloth", p, 12, false);
}

std::vector<BsdfCase> make_cases() {
    static const auto coat = CoatInterface::of(1.5);
    const Rgb white(1.0);
    std::vector<BsdfCase> c;
    c.push_back({"diffuse", DiffuseBsdf{white}, 1, true, true});
    c.push_back({"diffuse_transmission", DiffuseTransmissionBsdf{Rgb(0.7), Rgb(0.3)}, 1, true, true});
    c.push_back({"diffuse_transmission_coloured", DiffuseTransmissionBsdf{Rgb(0.1, 0.5, 0.2), Rgb(0.6, 0.1, 0.2)}, 1,
                 false, true, 2.0});
    c.push_back({"mirror", MirrorBsdf{white}, 1, true, true});
    c.push_back({"conductor", ConductorBsdf{kGold}, 1, false, true});
    for (const float alpha : {0.05f, 0.3f, 1.0f})
        c.push_back({"rough_conductor_" + std::to_string(alpha), RoughConductorBsdf{kWhite, alpha, alpha}});
    c.push_back({"rough_conductor_anisotropic", RoughConductorBsdf{kGold, 0.1f, 0.5f}});
    c.push_back({"glass", GlassBsdf{1.5}, 1.5, true, true});
    c.push_back({"bubble", GlassBsdf{1 / 1.33}, 1 / 1.33, true, true});
    for (const float alpha : {0.1f, 0.4f, 1.0f})
        c.push_back({"rough_dielectric_" + std::to_string(alpha), RoughDielectricBsdf{1.5f, alpha, alpha}, 1.5});
    c.push_back({"rough_dielectric_anisotropic", RoughDielectricBsdf{1.8f, 0.15f, 0.6f}, 1.8});
    c.push_back({"rough_dielectric_tinted",
                 RoughDielectricBsdf{1.5f, 0.3f, 0.3f, Rgb(0.9, 0.5, 0.2), Rgb(0.3, 0.7, 1.0)}, 1.5});
    c.push_back({"rough_bubble", RoughDielectricBsdf{0.75f, 0.3f, 0.3f}, 0.75});
    c.push_back({"thin_dielectric", ThinDielectricBsdf{1.5}, 1, true, true});
    c.push_back({"thin_dielectric_tinted", ThinDielectricBsdf{1.5, Rgb(0.9, 0.4, 0.1)}, 1, false, true});
    c.push_back({"interface", InterfaceBsdf{}, 1, true, true});
    c.push_back({"coated_diffuse", CoatedDiffuseBsdf(*coat, white, 0, 0, 0), 1, true, true, 3});
    c.push_back({"coated_diffuse_dark", CoatedDiffuseBsdf(*coat, Rgb(0.5, 0.1, 0.02), 0, 0, 0.01), 1, false, true, 8});
    c.push_back({"coated_diffuse_rough", CoatedDiffuseBsdf(*coat, white, 0.3, 0.3, 0), 1, false, false, 3});
    c.push_back({"coated_diffuse_anisotropic", CoatedDiffuseBsdf(*coat, Rgb(0.5), 0.1, 0.4, 0.1), 1, false, false, 3});
    c.push_back({"coated_conductor", CoatedConductorBsdf(*coat, {0, 0}, 0, kWhite, {0, 0}), 1, true, true});
    c.push_back({"coated_conductor_rough_base", CoatedConductorBsdf(*coat, {0, 0}, 0.01, kGold, {0.2f, 0.4f}), 1, false,
                 false, 2});
    c.push_back({"coated_conductor_rough_coat", CoatedConductorBsdf(*coat, {0.3f, 0.3f}, 0, kWhite, {0, 0}), 1, false,
                 false, 3});
    c.push_back({"coated_conductor_rough", CoatedConductorBsdf(*coat, {0.2f, 0.2f}, 0, kWhite, {0.5f, 0.5f}), 1, false,
                 false, 3});
    add_principled(c);
    return c;
}

} // namespace

const std::vector<BsdfCase>& bsdf_cases() {
    static const std::vector<BsdfCase> cases = make_cases();
    return cases;
}

const std::vector<Vec3>& looks() {
    static const std::vector<Vec3> list{Vec3(0, 0, 1), Vec3(0.3f, -0.2f, 0.8f).normalized(),
                                        Vec3(-0.9f, 0.4f, 0.25f).normalized(), Vec3(0.5f, 0.1f, -0.7f).normalized(),
                                        Vec3(-0.2f, -0.95f, -0.4f).normalized()};
    return list;
}

} // namespace keyhole::test
