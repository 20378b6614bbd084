#include "StridewireCharacter.h"

#include "IWebSocket.h"
#include "Modules/ModuleManager.h"
#include "WebSocketsModule.h"

// Tags of the fields that are used, as /v1/layout.json tells them: number << 3 | wire type.
namespace Tag
{
	constexpr uint32 AnimateRequest_open = 10;
	constexpr uint32 AnimateRequest_step = 18;
	constexpr uint32 Open_pacing = 16;
	constexpr uint32 Open_characters = 34;
	constexpr uint32 CharacterSpec_id = 8;
	constexpr uint32 Step_step = 8;
	constexpr uint32 Step_last_frame = 24;
	constexpr uint32 Step_velocity_xz = 50;
	constexpr uint32 AnimateResponse_opened = 10;
	constexpr uint32 AnimateResponse_frame = 18;
	constexpr uint32 AnimateResponse_error = 26;
	constexpr uint32 Opened_skeleton = 26;
	constexpr uint32 Skeleton_joints = 18;
	constexpr uint32 Frame_frame = 8;
	constexpr uint32 Frame_root = 50;
	constexpr uint32 Frame_hips = 66;
	constexpr uint32 Frame_rotations = 74;
}

constexpr uint32 PACING_SERVER = 2;

namespace
{
	using FBytes = TArray<uint8>;

	void PutVarint(FBytes& Out, uint32 Value)
	{
		for (; Value > 127; Value >>= 7) Out.Add(uint8(Value | 128));
		Out.Add(uint8(Value));
	}

	void PutNumber(FBytes& Out, uint32 Tag, uint32 Value)
	{
		PutVarint(Out, Tag);
		PutVarint(Out, Value);
	}

	void PutBytes(FBytes& Out, uint32 Tag, const void* Data, int32 Size)
	{
		PutNumber(Out, Tag, uint32(Size));
		Out.Append(static_cast<const uint8*>(Data), Size);
	}

	uint64 TakeVarint(TConstArrayView<uint8> In, int32& At)
	{
		uint64 Value = 0;
		for (int32 Shift = 0; At < In.Num() && Shift < 64; Shift += 7)
		{
			const uint8 Byte = In[At++];
			Value |= uint64(Byte & 127) << Shift;
			if (Byte < 128) break;
		}
		return Value;
	}

	// Calls a function with each field's tag, number and bytes; unknown fields are its to leave out.
	template <typename FTake>
	void EachField(TConstArrayView<uint8> In, FTake Take)
	{
		for (int32 At = 0; At < In.Num();)
		{
			const uint32 Tag = uint32(TakeVarint(In, At));
			uint64 Number = 0;
			int32 Size = 0;
			switch (Tag & 7)
			{
			case 0: Number = TakeVarint(In, At); break;
			case 1: Size = 8; break;
			case 2: Size = int32(TakeVarint(In, At)); break;
			case 5: Size = 4; break;
			default: return;
			}
			if (Size < 0 || Size > In.Num() - At) return;
			Take(Tag, Number, In.Slice(At, Size));
			At += Size;
		}
	}

	void CopyFloats(TArray<float>& Out, TConstArrayView<uint8> Block)
	{
		Out.SetNumUninitialized(Block.Num() / sizeof(float));
		FMemory::Memcpy(Out.GetData(), Block.GetData(), Out.Num() * sizeof(float));
	}

	// The importer of glTF swaps Y and Z: what is (x, y, z) here is 100 (x, z, y) in a mesh's bones. Swapping
	// changes handedness, and with it the sense of turns. A character then looks along +Y, as Unreal's own do.
	FVector Place(const TArray<float>& Block, int32 At)
	{
		return 100.0 * FVector(Block[At], Block[At + 2], Block[At + 1]);
	}

	FQuat Turn(const TArray<float>& Block, int32 At)
	{
		return FQuat(-Block[At + 1], -Block[At + 3], -Block[At + 2], Block[At]);
	}
}

AStridewireCharacter::AStridewireCharacter()
{
	PrimaryActorTick.bCanEverTick = true;
	RootComponent = CreateDefaultSubobject<USceneComponent>(TEXT("Root"));
	Mesh = CreateDefaultSubobject<UPoseableMeshComponent>(TEXT("Mesh"));
	Mesh->SetupAttachment(RootComponent);
}

void AStridewireCharacter::BeginPlay()
{
	Super::BeginPlay();
	auto& Module = FModuleManager::LoadModuleChecked<FWebSocketsModule>(TEXT("WebSockets"));
	Socket = Module.CreateWebSocket(Url, FString());
	Socket->OnConnected().AddWeakLambda(this, [this]
	{
		FBytes Character, Open, Request;
		PutNumber(Character, Tag::CharacterSpec_id, 1);
		PutNumber(Open, Tag::Open_pacing, PACING_SERVER);  // 60 frames a second by the server's clock
		PutBytes(Open, Tag::Open_characters, Character.GetData(), Character.Num());
		PutBytes(Request, Tag::AnimateRequest_open, Open.GetData(), Open.Num());
		Socket->Send(Request.GetData(), Request.Num(), true);
	});
	Socket->OnConnectionError().AddWeakLambda(this, [](const FString& Error)
	{
		UE_LOG(LogTemp, Error, TEXT("Stridewire: %s"), *Error);
	});
	Socket->OnRawMessage().AddUObject(this, &AStridewireCharacter::Receive);
	Socket->Connect();
}

void AStridewireCharacter::EndPlay(const EEndPlayReason::Type Reason)
{
	if (Socket) Socket->Close();
	Super::EndPlay(Reason);
}

// Sends the control that holds; a Step also acknowledges the newest frame.
void AStridewireCharacter::Tick(float Seconds)
{
	Super::Tick(Seconds);
	if (!Socket || !Socket->IsConnected() || Bones.IsEmpty()) return;
	const float Ours[] = {float(Velocity.X / 100.0), float(Velocity.Y / 100.0)};  // X is x, Y is z
	FBytes Control, Request;
	PutNumber(Control, Tag::Step_step, ++Step);
	PutNumber(Control, Tag::Step_last_frame, LastFrame);
	PutBytes(Control, Tag::Step_velocity_xz, Ours, sizeof(Ours));
	PutBytes(Request, Tag::AnimateRequest_step, Control.GetData(), Control.Num());
	Socket->Send(Request.GetData(), Request.Num(), true);
}

void AStridewireCharacter::Receive(const void* Data, SIZE_T Size, SIZE_T Remaining)
{
	Message.Append(static_cast<const uint8*>(Data), int32(Size));
	if (Remaining > 0) return;
	EachField(Message, [this](uint32 Kind, uint64, TConstArrayView<uint8> Inner)
	{
		if (Kind == Tag::AnimateResponse_error) UE_LOG(LogTemp, Warning, TEXT("Stridewire refused a message"));
		if (Kind == Tag::AnimateResponse_opened)
			EachField(Inner, [this](uint32 Field, uint64, TConstArrayView<uint8> Bytes)
			{
				if (Field == Tag::Opened_skeleton) Opened(Bytes);
			});
		if (Kind != Tag::AnimateResponse_frame) return;
		EachField(Inner, [this](uint32 Field, uint64 Number, TConstArrayView<uint8> Block)
		{
			if (Field == Tag::Frame_frame) LastFrame = uint32(Number);
			if (Field == Tag::Frame_root) CopyFloats(Root, Block);
			if (Field == Tag::Frame_hips) CopyFloats(Hips, Block);
			if (Field == Tag::Frame_rotations) CopyFloats(Rotations, Block);
		});
		Show();
	});
	Message.Reset();
}

// Finds the mesh's bones by the joints' names.
void AStridewireCharacter::Opened(TConstArrayView<uint8> Skeleton)
{
	EachField(Skeleton, [this](uint32 Field, uint64, TConstArrayView<uint8> Name)
	{
		if (Field != Tag::Skeleton_joints) return;
		const FUTF8ToTCHAR Joint(reinterpret_cast<const ANSICHAR*>(Name.GetData()), Name.Num());
		Bones.Add(Mesh->GetBoneIndex(FName(Joint.Length(), Joint.Get())));
	});
}

// The root moves the actor, the hips and the rotations move the bones.
void AStridewireCharacter::Show()
{
	if (Bones.IsEmpty() || Root.Num() < 7 || Hips.Num() < 3 || Rotations.Num() < 4 * Bones.Num()) return;
	SetActorLocationAndRotation(Place(Root, 0), Turn(Root, 3));
	for (int32 Joint = 0; Joint < Bones.Num(); Joint++)
	{
		if (!Mesh->BoneSpaceTransforms.IsValidIndex(Bones[Joint])) continue;
		FTransform& Bone = Mesh->BoneSpaceTransforms[Bones[Joint]];
		Bone.SetRotation(Turn(Rotations, 4 * Joint));
		if (Joint == 0) Bone.SetLocation(Place(Hips, 0));
	}
	Mesh->MarkRefreshTransformDirty();
}
