// An actor of Unreal Engine 5 that moves as a Stridewire server says, over a WebSocket.
//
// Untested: no Unreal was at hand where this was written. The tags in the .cpp are checked by a test.
//
//   1. stridewire serve --websocket 127.0.0.1:8080
//   2. stridewire stream --seconds 1 --out Character.glb; drag it into the content browser (Interchange).
//   3. In PROJECT.Build.cs add "WebSockets" to PublicDependencyModuleNames, put both files into Source/PROJECT.
//   4. Place a StridewireCharacter in a level, set its Mesh component's skinned asset to Character. Play.
//   5. Call SetVelocity from your pawn or from Blueprint; here it walks ahead until told otherwise.
#pragma once

#include "CoreMinimal.h"
#include "Components/PoseableMeshComponent.h"
#include "GameFramework/Actor.h"
#include "StridewireCharacter.generated.h"

class IWebSocket;

UCLASS()
class AStridewireCharacter : public AActor
{
	GENERATED_BODY()

public:
	AStridewireCharacter();

	UPROPERTY(EditAnywhere)
	FString Url = TEXT("ws://127.0.0.1:8080/v1/animate");

	UPROPERTY(VisibleAnywhere)
	TObjectPtr<UPoseableMeshComponent> Mesh;

	// Where to go, in Unreal's world: cm/s along X and Y.
	UFUNCTION(BlueprintCallable)
	void SetVelocity(FVector2D CentimetresPerSecond) { Velocity = CentimetresPerSecond; }

protected:
	virtual void BeginPlay() override;
	virtual void EndPlay(const EEndPlayReason::Type Reason) override;
	virtual void Tick(float Seconds) override;

private:
	void Receive(const void* Data, SIZE_T Size, SIZE_T Remaining);
	void Opened(TConstArrayView<uint8> Skeleton);
	void Show();

	TSharedPtr<IWebSocket> Socket;
	TArray<uint8> Message;  // comes in parts
	TArray<int32> Bones;    // of the mesh, by joint
	TArray<float> Root, Hips, Rotations;
	FVector2D Velocity = FVector2D(140.0, 0.0);
	uint32 Step = 0, LastFrame = 0;
};
